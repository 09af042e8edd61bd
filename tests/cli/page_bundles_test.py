#!/usr/bin/env python3
"""The bundles of the pages are those built from their sources, and the sources have no type errors.

Usage: page_bundles_test.py SOURCE_FOLDER

Skipped, with a message, without npm's tools: `scripts/setup --page` installs them.
"""

import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1])
BUNDLES = ("src/alhazen/explain/page/bundle/explanation.js", "apps/viewer/page/bundle/view.js")


def main():
    if not (SOURCE / "tools/page/node_modules").is_dir():
        print("skipped: no tools of the page here: scripts/setup --page installs them")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        made = subprocess.run([SOURCE / "scripts/page", folder], capture_output=True, text=True, timeout=200)
        print(made.stdout + made.stderr)
        if made.returncode:
            return 1
        for bundle in map(pathlib.Path, BUNDLES):
            new, old = (path.read_text(encoding="ascii") for path in (pathlib.Path(folder) / bundle.name, SOURCE / bundle))
            if new != old:
                print(f"{bundle} is not what its sources make: run scripts/page")
                return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
