#!/usr/bin/env python3
"""Functions of Python files, for agents.

    python3 bridge.py [--threads N]

See ../lib/helper.py for how it is asked.  `do` is one of

    load  name file             a module from a file; or
    load  name source           from text
    drop  name                  forget it
    call  module function args agent

`load` is answered with a list of {"name", "least", "most"}: the functions
that the module defines and whose names do not begin with `_`, or those of
its `__all__`, with how many arguments they take.

A module may `import typhon`:

    typhon.post(message, to=None)   a message to an agent on this host, or to
                                    the agent that called
    typhon.leave(fact)              a fact in the tuple space of the host
    typhon.caller()                 the agent that called, or None
"""

import argparse
import collections
import collections.abc
import dataclasses
import importlib.util
import inspect
import itertools
import os
import sys
import threading
import time
import types

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                '..', 'lib'))
from helper import BadRequest, Helper, Refusal, text           # noqa: E402

LONGEST_LIST = 1000000          # elements of what may have no end


def plain(value, depth=0):
    """Value as numbers, strings, lists and dicts with strings as keys."""
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if depth > 500:
        raise Refusal('exception', 'nested too deep',
                      **{'class': 'RecursionError'})
    if isinstance(value, dict):
        return {key if isinstance(key, str) else str(key):
                plain(part, depth + 1) for key, part in value.items()}
    if isinstance(value, (bytes, bytearray)):
        return value.decode('latin-1')
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return plain(dataclasses.asdict(value), depth + 1)
    if hasattr(value, 'tolist'):                # of numpy
        return plain(value.tolist(), depth + 1)
    if isinstance(value, (list, tuple, set, frozenset)):
        return [plain(part, depth + 1) for part in value]
    if isinstance(value, collections.abc.Iterable):
        parts = [plain(part, depth + 1)
                 for part in itertools.islice(value, LONGEST_LIST + 1)]
        if len(parts) > LONGEST_LIST:
            raise Refusal('exception', 'more than %d elements' % LONGEST_LIST,
                          **{'class': 'OverflowError'})
        return parts
    raise Refusal('exception', 'a result of type %s cannot be told to Prolog'
                  % type(value).__name__, **{'class': 'TypeError'})


def public(module):
    """The functions that a module defines, for others."""
    names = getattr(module, '__all__', None)
    for name, value in list(vars(module).items()):
        if not inspect.isfunction(value):
            continue
        if name in names if names is not None else (
                not name.startswith('_')
                and value.__module__ == module.__name__):
            arity = arities(value)
            if arity:
                yield {'name': name, 'least': arity[0], 'most': arity[1]}


def arities(function):
    """How many arguments it takes, or None if some must have names."""
    least = most = 0
    for parameter in inspect.signature(function).parameters.values():
        wanted = parameter.default is parameter.empty
        if parameter.kind in (parameter.POSITIONAL_ONLY,
                              parameter.POSITIONAL_OR_KEYWORD):
            least, most = least + wanted, most + 1
        elif parameter.kind == parameter.KEYWORD_ONLY and wanted:
            return None
    return least, most


class Functions(Helper):
    needed = ('load',)

    def __init__(self, threads):
        super().__init__(threads=threads, longest_queue=10000)
        self.modules = {}
        self.loads, self.loading = threading.Condition(), \
            collections.Counter()
        self.callers = threading.local()
        self.offer_module()

    def offer_module(self):
        """What `import typhon` gives."""
        module = types.ModuleType('typhon', 'Agents of Typhon.')
        module.post, module.leave = self.post, self.leave
        module.caller = self.caller
        sys.modules['typhon'] = module

    def caller(self):
        return getattr(self.callers, 'agent', None)

    def post(self, message, to=None):
        if to is None:
            to = self.caller()
        if not isinstance(to, str):
            raise TypeError('no agent to post to')
        self.event('post', to=to, message=plain(message))

    def leave(self, fact):
        self.event('leave', fact=plain(fact))

    def coming(self, request):
        with self.loads:
            self.loading[str(request.get('name'))] += 1

    def do_load(self, request, _deadline):
        try:
            return self.load(request)
        finally:
            with self.loads:
                self.loading[str(request.get('name'))] -= 1
                self.loads.notify_all()

    def module(self, name, deadline):
        """The module, when those that were to be loaded before are."""
        with self.loads:
            self.loads.wait_for(lambda: name in self.modules
                                or self.loading[name] <= 0,
                                deadline - time.monotonic())
            return self.modules.get(name)

    def load(self, request):
        name = text(request, 'name')
        try:
            if 'source' in request:
                module = self.from_source(name, text(request, 'source'))
            else:
                module = self.from_file(name, text(request, 'file'))
        except SyntaxError as problem:
            raise Refusal('exception', str(problem),
                          **{'class': type(problem).__name__}) from None
        self.modules[name] = module
        return list(public(module))

    def from_source(self, name, source):
        module = types.ModuleType(name)
        exec(compile(source, name + '.py', 'exec'), vars(module))
        return module

    def from_file(self, name, file):
        folder = os.path.dirname(file)
        if folder not in sys.path:
            sys.path.insert(0, folder)
        spec = importlib.util.spec_from_file_location(name, file)
        if spec is None:
            raise BadRequest('file: not a Python file')
        module = importlib.util.module_from_spec(spec)
        sys.modules.setdefault(name, module)
        spec.loader.exec_module(module)
        return module

    def do_drop(self, request, _deadline):
        self.modules.pop(text(request, 'name'), None)
        return {}

    def do_call(self, request, deadline):
        module = self.module(text(request, 'module'), deadline)
        function = getattr(module, text(request, 'function'), None)
        arguments = request.get('args')
        if function is None or not isinstance(arguments, list):
            raise BadRequest('there is no such function')
        self.callers.agent = request.get('agent')
        try:
            return plain(function(*arguments))
        finally:
            self.callers.agent = None


def main():
    parser = argparse.ArgumentParser(description='Python for agents.')
    parser.add_argument('--threads', type=int, default=8)
    Functions(parser.parse_args().threads).run()


if __name__ == '__main__':
    main()
