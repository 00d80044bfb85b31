"""Carries bytes between a terminal and the standard streams, raw.

    python3 test/lib/pty_relay.py LINK

for tests in a language that cannot open a terminal without the risk of
making it its own. Ends when either side does."""

import os
import select
import sys


def main():
    line = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
    ways = {0: line, line: 1}
    while True:
        for source in select.select(list(ways), [], [])[0]:
            data = os.read(source, 4096)
            if not data:
                return
            os.write(ways[source], data)


try:
    main()
except OSError:                 # the terminal has gone
    pass
