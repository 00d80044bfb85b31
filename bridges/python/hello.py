"""The smallest file for python_start/3; `diagnose python` calls it."""


def hello(name):
    return 'hello ' + name
