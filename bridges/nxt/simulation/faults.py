"""Faults of the line and of the brick, switched on when asked for."""

KINDS = {'delay': float, 'silence': None, 'garbage': None, 'cut': float,
         'battery': int, 'refuse': lambda word: int(word, 0)}
NEEDS = ('delay', 'battery', 'refuse')


class Fault:
    def __init__(self, kind, arg=None, after=0, last=None):
        self.kind, self.arg = kind, arg
        self.after, self.last = after, last

    def due(self):
        """Counts telegrams: is this one struck?"""
        if self.after:
            self.after -= 1
            return False
        if self.last is None:
            return True
        self.last -= 1
        return self.last >= 0


def parse(words):
    """delay 0.5 after 3 for 2; ValueError if it is no fault."""
    words = list(words)
    kind = words.pop(0) if words else ''
    if kind not in KINDS:
        raise ValueError('no such fault: ' + kind)
    arg = None
    if words and words[0] not in ('after', 'for'):
        if KINDS[kind] is None:
            raise ValueError(kind + ' takes no argument')
        arg = KINDS[kind](words.pop(0))
    if arg is None and kind in NEEDS:
        raise ValueError(kind + ' needs an argument')
    after, last = times(words)
    if kind == 'cut' and last is None:
        last = 1                # what comes back is whole again
    return Fault(kind, arg, after, last)


def times(words):
    after, last = 0, None
    while words:
        if len(words) < 2 or words[0] not in ('after', 'for'):
            raise ValueError('after N, for M')
        number = int(words[1])
        if words[0] == 'after':
            after = number
        else:
            last = number
        del words[:2]
    return after, last


class Faults:
    def __init__(self):
        self.active = []

    def add(self, fault):
        self.active.append(fault)

    def clear(self):
        self.active = []

    def strike(self):
        """{kind: argument} of what happens to the telegram at hand."""
        struck = {f.kind: f.arg for f in self.active if f.due()}
        self.active = [f for f in self.active if f.last is None or f.last > 0]
        return struck
