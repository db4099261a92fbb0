"""Writes into build/packages what the packages there consist of, as CycloneDX: /usr/bin/python3 scripts/packaging/sbom.py deb|wheel...

For Debian packages: the packages that they depend on. For wheel and archive: what auditwheel has copied into them, by its own list. In
both: libraries that are compiled in, which are those of the `packages` files without a shared library. Versions are this machine's."""

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


def installed(names: set[str]) -> list[dict]:
    """Those of these Debian packages that are installed, as components."""
    known = run("dpkg-query", "--show", "--showformat", "${Package} ${Version} ${Architecture} ${db:Status-Status}\n").splitlines()
    rows = sorted(line.split() for line in known)
    return [
        {"type": "library", "name": name, "version": version, "bom-ref": f"{name}:{arch}", "purl": f"pkg:deb/{SYSTEM}/{name}@{version}?arch={arch}"}
        for name, version, arch, status in rows
        if name in names and status == "installed"
    ]


def compiled_in() -> list[dict]:
    """Libraries of headers, and those of the pages, which need no file of their package at run time."""
    listed = {name for file in pathlib.Path("components").glob("*/packages") for name in re.findall(r"^[a-z][\w.+-]*", file.read_text(), re.MULTILINE)}
    found = installed({name for name in listed if name.endswith("-dev") or name.startswith("libjs-")})
    return [each for each in found if not re.search(r"\.so(\n|$)", run("dpkg-query", "--listfiles", each["name"]))]


def write(file: pathlib.Path, name: str, version: str, libraries: list[dict]) -> None:
    about = {"type": "application", "name": name, "version": version, "bom-ref": "insonify"}
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
    write(PACKAGES / f"insonify-{version}-deb.sbom.json", "insonify", version, installed(names - {"insonify"}) + compiled_in())


def describe_wheel() -> None:
    copied = json.loads(pathlib.Path("build/wheel/copied.cdx.json").read_text())
    about = copied["metadata"]["component"]
    libraries = [each for each in copied["components"] if each["bom-ref"] != about["bom-ref"]]
    write(PACKAGES / f"insonify-{about['version']}-{platform.machine()}.sbom.json", "insonify", about["version"], libraries + compiled_in())


for old in PACKAGES.glob("*.sbom.json"):
    if ("-deb" in old.name) == ("deb" in sys.argv):
        old.unlink()
if "deb" in sys.argv:
    describe_debs()
if "wheel" in sys.argv:
    describe_wheel()
