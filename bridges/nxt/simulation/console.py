"""What can be asked of a brick, and done to it, beside its protocol."""

from . import faults
from .devices import parse
from .loop import quoted


def term(value):
    """A number or a name as Prolog reads it."""
    if isinstance(value, float):
        return f'{value:.4f}'
    if isinstance(value, int):
        return str(value)
    plain = value.isidentifier() and value[:1].islower() and value.isascii()
    return value if plain else quoted(value)


def terms(values):
    return '[' + ', '.join(values) + ']'


def where(name, station):
    pty = f'pty({quoted(station.link)})' if station.link else 'none'
    tcp = f'tcp({station.port})' if station.server else 'none'
    return f'brick({term(name)}, {pty}, {tcp})'


class Console:
    def __init__(self, station, step_to_now):
        self.station, self.brick = station, station.brick
        self.step_to_now = step_to_now

    def do(self, words):
        """The answer to a line; ValueError if it means nothing."""
        command = getattr(self, 'do_' + words[0], None)
        if command is None:
            raise ValueError('no such command: ' + words[0])
        self.step_to_now()
        return command(*words[1:])

    def do_fault(self, *words):
        if words == ('none',):
            self.station.faults.clear()
            self.brick.set_battery(self.brick.full_battery)
            return 'ok'
        fault = faults.parse(words)
        if fault.kind == 'battery' and not fault.after:
            self.brick.set_battery(fault.arg)
        if fault.kind == 'cut' and not fault.after and not words[1:]:
            self.station.cut_now()
        else:
            self.station.faults.add(fault)
        return 'ok'

    def do_restore(self):
        self.station.restore()
        return where(self.brick.label, self.station)

    def do_restart(self):
        self.brick.restart()
        return 'ok'

    def do_set(self, port, *value):
        if not value:
            raise ValueError('set PORT VALUE')
        self.port(port).device.set(parse(value))
        return 'ok'

    def do_plug(self, port, kind, *value):
        self.port(port)
        self.brick.plug(int(port) - 1, kind, parse(value) if value else None)
        return 'ok'

    def port(self, port):
        if port not in ('1', '2', '3', '4'):
            raise ValueError('sensor ports are 1 to 4')
        return self.brick.inputs[int(port) - 1]

    def motor(self, letter):
        if letter.upper() not in ('A', 'B', 'C'):
            raise ValueError('motors are A, B and C')
        return self.brick.motors['ABC'.index(letter.upper())]

    def do_load(self, letter, fraction):
        self.motor(letter).load = min(1.0, max(0.0, float(fraction)))
        return 'ok'

    def do_motor(self, letter):
        m = self.motor(letter)
        values = (letter.lower(), m.power, m.run_state, round(m.speed, 1),
                  *m.counters())
        return f'motor({", ".join(map(str, values))})'

    def do_sounds(self):
        found = [f'{what}({t:.3f}, {term(a)}, {b})'
                 for t, what, a, b in self.brick.sounds]
        return f'sounds({terms(found)})'

    def do_program(self):
        return f'program({term(self.brick.program or "none")})'

    def do_count(self):
        return f'count({self.brick.telegrams}, {self.brick.replies})'

    def do_empty_reads(self):
        counts = [str(port.lowspeed.empty_reads)
                  for port in self.brick.inputs]
        return f'empty_reads({", ".join(counts)})'

    def do_time(self):
        return f'time({self.brick.time:.3f})'

    def do_advance(self, seconds):
        if float(seconds) < 0:
            raise ValueError('time does not go back')
        self.station.clock.advance(float(seconds))
        self.step_to_now()
        return 'ok'

    def do_quit(self):
        self.station.loop.stop()
        return 'ok'
