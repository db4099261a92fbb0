"""Writes into build/packages what the Debian packages there consist of, as CycloneDX: /usr/bin/python3 scripts/packaging/sbom.py

With the name of a file it writes there the `copyright` of the Debian packages: our licence, and those of what is compiled in. The list has
the packages that they depend on, and the libraries that are compiled in, which are those of the `packages` files without a
shared library. wheel.py writes the same of wheel and archive. Versions are this machine's."""

import json
import pathlib
import platform
import re
import subprocess
import sys

PACKAGES = pathlib.Path("build/packages")
SYSTEM = platform.freedesktop_os_release()["ID"]


def run(*command: str | pathlib.Path) -> str:
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE).stdout


def copyright_of(package: str) -> str:
    """The package's copyright file; a sentence where the system leaves such files out."""
    file = pathlib.Path(f"/usr/share/doc/{package}/copyright")
    return file.read_text(errors="replace") if file.exists() else f"{package}: its Debian package has the copyright, this machine left it out\n"


def licences(package: str) -> list[dict]:
    """Those that the package's copyright file names, also of single files; the text of one that names none."""
    text = copyright_of(package)
    names = dict.fromkeys(re.findall(r"^License:[ \t]*(\S.*?)[ \t]*$", text, re.MULTILINE))
    if names:
        return [{"license": {"name": name}} for name in names]
    return [{"license": {"name": f"copyright of {package}", "text": {"contentType": "text/plain", "content": text}}}]


def installed(names: set[str]) -> list[dict]:
    """Those of these Debian packages that are installed, as components."""
    known = run("dpkg-query", "--show", "--showformat", "${Package} ${Version} ${Architecture} ${db:Status-Status}\n").splitlines()
    rows = sorted(line.split() for line in known)
    return [
        {
            "type": "library",
            "name": name,
            "version": version,
            "bom-ref": f"{name}:{arch}",
            "purl": f"pkg:deb/{SYSTEM}/{name}@{version}?arch={arch}",
            "licenses": licences(name),
        }
        for name, version, arch, status in rows
        if name in names and status == "installed"
    ]


def compiled_in() -> list[dict]:
    """Libraries of headers, and those of the pages, which need no file of their package at run time."""
    lists = [*pathlib.Path("components").glob("*/packages"), pathlib.Path("types/packages")]
    listed = {name for file in lists for name in re.findall(r"^[a-z][\w.+-]*", file.read_text(), re.MULTILINE)}
    found = []
    wanted = {name for name in listed if name.endswith("-dev") or name.startswith("libjs-")}
    while wanted:
        others: set[str] = set()
        for each in installed(wanted):
            files = run("dpkg-query", "--listfiles", each["name"])
            if re.search(r"\.so(\n|$)", files):
                continue
            if re.search(r"\.(h|hpp|js)(\n|$)", files):
                found.append(each)
            else:  # libboost-dev only names another package
                others |= set(re.findall(r"[\w.+-]+-dev", run("dpkg-query", "--show", "--showformat", "${Depends}", each["name"])))
        wanted = others
    return found


def copyright() -> str:
    """Our licence, and the copyright file of each package that is compiled in."""
    parts = [f"Insonify\n\n{pathlib.Path('LICENSE').read_text()}"]
    for each in compiled_in():
        parts.append(f"{each['name']} {each['version']}, which is compiled in\n\n{copyright_of(each['name'])}")
    return f"\n{'=' * 80}\n\n".join(parts)


def write(file: pathlib.Path, version: str, libraries: list[dict]) -> None:
    about = {"type": "application", "name": "insonify", "version": version, "bom-ref": "insonify", "licenses": [{"license": {"id": "Apache-2.0"}}]}
    commit = run("git", "log", "-1", "--format=%H").strip() if pathlib.Path(".git").exists() else ""
    if commit:
        about["properties"] = [{"name": "commit", "value": commit}]
    refs = [each["bom-ref"] for each in libraries]
    text = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.4",
        "version": 1,
        "metadata": {"component": about},
        "components": libraries,
        "dependencies": [{"ref": "insonify", "dependsOn": refs}, *({"ref": ref} for ref in refs)],
    }
    file.write_text(json.dumps(text, indent=2) + "\n")


def describe_debs() -> None:
    debs = sorted(PACKAGES.glob("*.deb"))
    depends = " ".join(run("dpkg-deb", "--field", deb, "Depends") for deb in debs)
    names = set(re.findall(r"[a-z0-9][a-z0-9+.-]+", re.sub(r"\([^)]*\)", "", depends)))
    version = run("dpkg-deb", "--field", debs[0], "Version").strip()
    write(PACKAGES / f"insonify-{version}-deb.sbom.json", version, installed(names | {each["name"] for each in compiled_in()}))


if __name__ == "__main__" and sys.argv[1:]:
    pathlib.Path(sys.argv[1]).write_text(copyright())
elif __name__ == "__main__":
    for old in PACKAGES.glob("*-deb.sbom.json"):
        old.unlink()
    describe_debs()
