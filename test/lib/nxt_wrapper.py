#!/usr/bin/python3 -u
"""A Python without rights: runs a helper as nobody.

All it needs is loaded first; nobody may not be able to read it later.
"""

import os
import sys

arguments = [argument for argument in sys.argv[1:] if argument != '-u']
sys.path.insert(0, os.path.dirname(arguments[0]))
import bridge                           # noqa: E402

if os.getuid() == 0:
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)
sys.argv = arguments
bridge.main()
