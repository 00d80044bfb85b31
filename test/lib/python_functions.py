"""Functions for test/prolog/bridges/python/test_python.pl."""

import itertools
import json                             # not offered: of another module
import os
import subprocess
import sys
import threading
import time

import typhon

COUNT = 0
MET = threading.Barrier(4)
GO = threading.Event()


def echo(value):
    return value


def area(width, height=2, unit='m'):
    return {'area': width * height, 'unit': unit}


def kind(value):
    return type(value).__name__


def nap(seconds):
    typhon.leave('waits')
    time.sleep(seconds)
    return seconds


def meet():
    """Returns when four are here."""
    MET.wait(20)
    return True


def held():
    """Returns when let_go is called."""
    typhon.leave('waits')
    return GO.wait(20)


def let_go():
    GO.set()


def count():
    global COUNT
    COUNT += 1
    return COUNT


def fail(kind, message):
    raise {'value': ValueError, 'os': OSError}[kind](message)


def leave_process(status):
    os._exit(status)


def leave_politely():
    sys.exit(7)


def noise():
    print('{"id": 1, "ok": "nonsense"}')
    subprocess.run(['echo', 'so'])
    return 'done'


def odd(which):
    return {'tuple': (1, 'a'), 'set': {1}, 'bytes': b'\x00\xff',
            'range': range(3), 'nan': float('nan'), 'object': object(),
            'key': {1: 'one'}, 'endless': itertools.repeat(1), 'big': 10 ** 30}[which]


def long(size):
    return [0] * size


def deep(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


def big(size):
    return 'x' * size


def post(count):
    for n in range(count):
        typhon.post({'n': n})
    return typhon.caller()


def post_to(agent, message):
    typhon.post(message, to=agent)


def leave_fact(value):
    typhon.leave(value)


def named(*, must):
    return must


def _hidden():
    return json.dumps(1)
