"""The main program of every check of the source tree: `--self-test`, or the check of the tree that holds this file."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def run(check, self_test, nothing_found):
    """check(root) returns the lines to print, self_test() the number of wrong cases. The exit status is 1 if there are any."""
    if "--self-test" in sys.argv:
        sys.exit(1 if self_test() else 0)
    found = check(ROOT)
    print("\n".join(found) if found else nothing_found)
    sys.exit(1 if found else 0)
