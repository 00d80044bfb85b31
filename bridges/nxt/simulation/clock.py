"""The time of a simulation."""

import time


class Clock:
    """Counts `rate` seconds for every second of the host.

    With rate 0 time stands still but for advance(), so that a run depends
    on nothing but its commands."""

    def __init__(self, rate=1.0):
        self.rate = rate
        self.base = 0.0
        self.start = time.monotonic()

    def now(self):
        return self.base + (time.monotonic() - self.start) * self.rate

    def advance(self, seconds):
        self.base += seconds
