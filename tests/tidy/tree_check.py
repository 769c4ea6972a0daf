"""The main program of every check of the source tree: runs the self-test with --self-test, else checks this file's tree."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def run(check, self_test, nothing_found):
    """check(root) returns the lines to print, self_test() the number of failed cases. Exits with 1 if there are any."""
    if "--self-test" in sys.argv:
        sys.exit(1 if self_test() else 0)
    found = check(ROOT)
    print("\n".join(found) if found else nothing_found)
    sys.exit(1 if found else 0)
