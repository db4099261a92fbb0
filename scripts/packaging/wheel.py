"""Makes the wheel and the archive from build/: python scripts/packaging/wheel.py wheel|archive...

auditwheel copies the system libraries that they are linked with into them, except those of glibc and of OpenGL;
their licences and the list of what the wheel consists of are added."""

import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tarfile

import sbom
import zstandard
from scikit_build_core import build as backend

PACKAGES = pathlib.Path("build/packages")
STAGE = pathlib.Path("build/wheel")


def run(*command: str | pathlib.Path) -> str:
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE).stdout


def stage() -> pathlib.Path:
    """A folder with our own files of the wheel."""
    shutil.rmtree(STAGE, ignore_errors=True)
    folder = STAGE / "own"
    run("cmake", "--install", "build", "--component", "python", "--prefix", folder, "--strip")
    library = next((folder / "insonify/lib").glob("libinsonify.so.*.*.*"))  # wheels cannot contain links
    library.replace(library.with_suffix(""))
    about = folder / backend.prepare_metadata_for_build_wheel(str(folder))
    (about / "RECORD").unlink(missing_ok=True)
    (about / "WHEEL").write_text(
        "Wheel-Version: 1.0\nGenerator: scripts/package\nRoot-Is-Purelib: false\n"
        f"Tag: py3-none-linux_{platform.machine()}\n"
    )
    return folder


def licences(bundled: pathlib.Path, to: pathlib.Path) -> list[dict]:
    """Copies the licences of the copied libraries, and of those that are compiled in, from their Debian packages, which it returns."""
    to.mkdir()
    packages = {each["name"] for each in sbom.compiled_in()}
    for library in sorted(bundled.glob("*.so*")):
        name = re.sub(r"-[0-9a-f]{8}(?=\.)", "", library.name)
        if name == "libGLX.so.0":
            continue
        owners = run("dpkg-query", "--search", f"*/{name}")
        packages.add(owners.split(":")[0])
    for package in packages:
        shutil.copy(f"/usr/share/doc/{package}/copyright", to / f"{package}.txt")
    return sbom.installed(packages)


def make() -> pathlib.Path:
    """The folder of the whole wheel, unpacked."""
    run("wheel", "pack", stage(), "--dest-dir", STAGE)
    major, minor = platform.libc_ver()[1].split(".")
    plain = next(STAGE.glob("*.whl"))
    windowless = STAGE / "windowless"
    windowless.mkdir()
    run("cc", "-shared", "-fPIC", "-Os", "-s", "-Wl,-soname,libGLX.so.0", "-o", windowless / "libGLX.so.0", "scripts/packaging/glx.c")
    os.environ["LD_LIBRARY_PATH"] = str(windowless.resolve())
    run("auditwheel", "repair", plain, "--plat", f"manylinux_{major}_{minor}_{platform.machine()}", "--wheel-dir", STAGE / "repaired")
    run("wheel", "unpack", next((STAGE / "repaired").glob("*.whl")), "--dest", STAGE / "whole")
    folder = next((STAGE / "whole").iterdir())
    libraries = licences(folder / "insonify.libs", folder / "insonify.libs/licences")
    lists = next(folder.glob("*.dist-info/sboms"))
    shutil.rmtree(lists)  # auditwheel's lacks what is compiled in, and some that it has copied
    lists.mkdir()
    sbom.write(lists / "insonify.cdx.json", folder.name.split("-")[1], libraries)
    return folder


def make_archive(folder: pathlib.Path) -> None:
    """Without the files that only pip needs."""
    name = f"{folder.name}-{platform.machine()}"
    for about in (*folder.glob("*.data"), *folder.glob("*.dist-info")):
        shutil.rmtree(about)
    shutil.copy("LICENSE", folder)
    (folder / "bin").mkdir()
    (folder / "bin/insonify").symlink_to("../insonify/bin/insonify")
    with (
        open(PACKAGES / f"{name}.tar.zst", "wb") as file,
        zstandard.ZstdCompressor(level=12, threads=-1).stream_writer(file) as packer,
        tarfile.open(fileobj=packer, mode="w|") as archive,
    ):
        archive.add(folder, name)


for old in (*PACKAGES.glob("*.whl"), *PACKAGES.glob("*.tar.zst"), *PACKAGES.glob(f"*-{platform.machine()}.sbom.json")):
    old.unlink()
whole = make()
shutil.copy(next(whole.glob("*.dist-info/sboms/*")), PACKAGES / f"{whole.name}-{platform.machine()}.sbom.json")
if "wheel" in sys.argv:
    run("wheel", "pack", whole, "--dest-dir", PACKAGES)
if "archive" in sys.argv:
    make_archive(whole)
