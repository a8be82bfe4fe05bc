"""Writes the bill of materials of a release: what Clamber runs with, by the lock file, with licences and hashes, as CycloneDX 1.6."""

import argparse
import json
import re
import sys
import uuid
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
LOCKED = re.compile(r"^(?P<name>[A-Za-z0-9._-]+)==(?P<version>[^ ;\\]+)(?: *; *(?P<marker>[^\\]+?))? *\\?$")
HASH = re.compile(r"--hash=sha256:([0-9a-f]{64})")
EXTRAS = ("view", "video")
"""Of Clamber, in the lock file of who runs it."""
BUILD = "setuptools"
"""Is locked to install Clamber with, and is no part of it where nothing else asks for it."""


def locked(path: Path) -> dict[str, tuple[str, list[str]]]:
    """Version and SHA-256 of the files of each package in a lock file, by its normalised name; those for other systems are left out."""
    found: dict[str, tuple[str, list[str]]] = {}
    name = ""
    for line in path.read_text("utf-8").splitlines():
        if (match := LOCKED.match(line)) is not None:
            marker = match["marker"]
            name = str(canonicalize_name(match["name"])) if marker is None or Marker(marker).evaluate() else ""
            if name:
                found[name] = (match["version"], [])
        elif name:
            found[name][1].extend(HASH.findall(line))
    return found


def licences(about: metadata.PackageMetadata) -> list[dict[str, Any]]:
    """What a package says of its licence: an SPDX expression, else its classifiers, else its own words."""
    if (expression := about.get("License-Expression")) is not None:
        return [{"expression": expression}]
    named = [
        line.rpartition(" :: ")[2] for line in about.get_all("Classifier") or () if line.startswith("License :: OSI")
    ]
    said = (about.get("License") or "").strip().partition("\n")[0]
    return [{"license": {"name": name}} for name in named or ([said] if said else [])]


def needs(name: str, extras: tuple[str, ...] = ()) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Packages that one asks for on this system, with the extras of theirs that it asks for."""
    for text in metadata.requires(name) or ():
        asked = Requirement(text)
        if asked.marker is None or any(asked.marker.evaluate({"extra": extra}) for extra in ("", *extras)):
            yield str(canonicalize_name(asked.name)), tuple(asked.extras)


def dependencies(names: set[str]) -> dict[str, list[str]]:
    """What each package asks for, among those that are named, beginning with Clamber's own."""
    found: dict[str, set[str]] = {}
    open_ = [("clamber", EXTRAS)]
    seen = set(open_)
    while open_:
        name, extras = open_.pop()
        below = [pair for pair in needs(name, extras) if pair[0] in names]
        found.setdefault(name, set()).update(other for other, _ in below)
        open_ += [pair for pair in below if pair not in seen]
        seen.update(below)
    return {name: sorted(others) for name, others in sorted(found.items())}


def bill(lock: Path) -> dict[str, Any]:
    """The bill of materials, the same bytes for the same lock file and system.

    Raises:
        SystemExit: If what is installed is not what is locked, or states no licence.
    """
    packages = locked(lock)
    graph = dependencies(set(packages))
    components = []
    for name, (version, hashes) in sorted(packages.items()):
        if name == BUILD and name not in graph:
            continue
        about = metadata.metadata(name)
        if about["Version"] != version:
            sys.exit(f"{name} {about['Version']} is installed, {lock.name} says {version}: run `make setup` first")
        stated = licences(about)
        if not stated:
            sys.exit(f"{name} {version} states no licence")
        components.append(
            {
                "type": "library",
                "bom-ref": f"pkg:pypi/{name}@{version}",
                "name": about["Name"],
                "version": version,
                "purl": f"pkg:pypi/{name}@{version}",
                "licenses": stated,
                "hashes": [{"alg": "SHA-256", "content": value} for value in hashes],
            }
        )
    version = metadata.version("clamber")
    refs = {name: f"pkg:pypi/{name}@{made}" for name, (made, _) in packages.items()} | {
        "clamber": f"pkg:pypi/clamber@{version}"
    }
    body = {
        "metadata": {
            "component": {
                "type": "application",
                "bom-ref": refs["clamber"],
                "name": "clamber",
                "version": version,
                "purl": refs["clamber"],
                "licenses": [{"expression": "Apache-2.0"}],
            }
        },
        "components": components,
        "dependencies": [
            {"ref": refs[name], "dependsOn": [refs[other] for other in others]} for name, others in graph.items()
        ],
    }
    serial = uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(body, sort_keys=True))
    head = {"bomFormat": "CycloneDX", "specVersion": "1.6", "serialNumber": f"urn:uuid:{serial}", "version": 1}
    return head | body


def main() -> None:
    """Write it to a file."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--lock", type=Path, default=ROOT / "requirements-run.txt")
    words.add_argument("-o", "--output", type=Path, required=True)
    asked = words.parse_args()
    asked.output.write_text(json.dumps(bill(asked.lock), indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    main()
