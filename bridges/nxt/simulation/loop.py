"""One thread that waits for bytes, for lines and for its time."""

import heapq
import itertools
import os
import selectors
import signal
import time


class Loop:
    def __init__(self):
        self.selector = selectors.DefaultSelector()
        self.timers = []
        self.order = itertools.count()
        self.running = True
        self.wake, self.bell = os.pipe()
        os.set_blocking(self.bell, False)
        os.set_blocking(self.wake, False)
        self.add(self.wake, lambda: os.read(self.wake, 100))

    def add(self, file, ready):
        self.selector.register(file, selectors.EVENT_READ, ready)

    def remove(self, file):
        try:
            self.selector.unregister(file)
        except (KeyError, ValueError):
            pass

    def after(self, seconds, action):
        due = time.monotonic() + seconds
        heapq.heappush(self.timers, (due, next(self.order), action))

    def stop(self, *_):
        self.running = False

    def stop_on_signals(self):
        signal.set_wakeup_fd(self.bell, warn_on_full_buffer=False)
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            signal.signal(number, self.stop)
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)

    def run(self):
        while self.running:
            for key, _ in self.selector.select(self.patience()):
                if self.running and key.fileobj in self.selector.get_map():
                    key.data()
            self.run_timers()

    def patience(self):
        if not self.timers:
            return None
        return max(0.0, self.timers[0][0] - time.monotonic())

    def run_timers(self):
        while (self.running and self.timers
               and self.timers[0][0] <= time.monotonic()):
            heapq.heappop(self.timers)[2]()


class Lines:
    """Lines from a file descriptor, answered one by one on standard output.

    answer(words) gives a term, or None for nothing; ValueError is printed."""

    def __init__(self, loop, answer, at_end=None, fd=0):
        self.loop, self.answer, self.at_end = loop, answer, at_end
        self.fd = fd
        self.buffer = b''
        try:
            loop.add(fd, self.ready)
        except PermissionError:         # a plain file, which is always ready
            loop.after(0, self.drain)
        except (OSError, ValueError):
            self.end()                  # closed

    def drain(self):
        while self.fd is not None and self.loop.running:
            self.ready()

    def ready(self):
        try:
            data = os.read(self.fd, 4096)
        except OSError:                 # a terminal that is not ours to read
            data = b''
        if not data:
            self.end()
            return
        *lines, self.buffer = (self.buffer + data).split(b'\n')
        for line in lines:
            self.serve(line.decode('utf-8', 'replace').split())

    def end(self):
        if self.fd is not None:
            self.loop.remove(self.fd)
        self.fd = None
        if self.at_end:
            self.at_end()

    def serve(self, words):
        if not words or words[0].startswith('#'):
            return
        try:
            say(self.answer(words))
        except (ValueError, KeyError, IndexError, TypeError, OSError) as bad:
            say(f'error({quoted(describe(bad))})')


def describe(error):
    if isinstance(error, (KeyError, IndexError)):
        return f'not known or missing: {error}'
    return str(error)


def quoted(text):
    """As a Prolog atom."""
    text = str(text).replace('\\', '\\\\').replace("'", "\\'")
    return "'" + text.replace('\n', ' ') + "'"


def say(term):
    if term is not None:
        try:
            os.write(1, (term + '.\n').encode())
        except OSError:                 # its reader is gone
            pass
