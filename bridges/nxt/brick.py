#!/usr/bin/env python3
"""A simulated NXT brick on a pseudo-terminal, a TCP port or both.

    python3 bridges/nxt/brick.py --pty /tmp/nxt --tcp 5001

speaks LEGO's protocol 1.124 as over Bluetooth. When it is ready it prints
a line; lines on standard input change its sensors and make it fail. See
doc/brick.md."""

import argparse
import sys

from simulation import faults
from simulation.clock import Clock
from simulation.console import Console, where
from simulation.devices import KINDS, parse
from simulation.firmware import Brick
from simulation.line import Station
from simulation.loop import Lines, Loop, say


def port_option(text):
    """3=compass:90"""
    port, _, what = text.partition('=')
    kind, _, value = what.partition(':')
    if port not in ('1', '2', '3', '4') or kind not in KINDS:
        raise argparse.ArgumentTypeError(
            f'{text}: PORT=KIND[:VALUE], kinds {" ".join(KINDS)}')
    return int(port) - 1, kind, parse(value.split(',')) if value else None


def fault_option(text):
    try:
        return faults.parse(text.split())
    except ValueError as bad:
        raise argparse.ArgumentTypeError(bad)


def options():
    parser = argparse.ArgumentParser(
        description='A simulated NXT brick.', allow_abbrev=False)
    add = parser.add_argument
    add('--pty', metavar='LINK', help='symbolic link to a pseudo-terminal')
    add('--tcp', metavar='PORT', type=int,
        help='TCP port of this machine, 0: any')
    add('--name', default='NXT', help='of the brick')
    add('--port', metavar='P=KIND[:VALUE]', type=port_option, default=[],
        action='append', help='what is plugged into a sensor port')
    add('--fault', metavar='WORDS', type=fault_option, default=[],
        action='append', help='as the line "fault WORDS"')
    add('--clock', metavar='RATE', type=float, default=1.0,
        help='seconds per second; 0: only by "advance SECONDS"')
    add('--seed', type=int, default=0, help='of garbage')
    add('--until-eof', action='store_true',
        help='end when standard input ends')
    chosen = parser.parse_args()
    if chosen.pty is None and chosen.tcp is None:
        parser.error('nothing to listen on: --pty LINK, --tcp PORT or both')
    return chosen


def station_of(chosen, loop):
    brick = Brick(chosen.name)
    for port, kind, value in chosen.port:
        brick.plug(port, kind, value)
    struck = faults.Faults()
    for fault in chosen.fault:
        if fault.kind == 'battery' and not fault.after:
            brick.set_battery(fault.arg)
        struck.add(fault)
    return Station(loop, Clock(chosen.clock), brick, struck, chosen.seed)


def main():
    chosen = options()
    loop = Loop()
    loop.stop_on_signals()
    station = station_of(chosen, loop)
    try:
        station.open(chosen.pty, chosen.tcp)
        console = Console(
            station, lambda: station.brick.advance(station.clock.now()))
        say(f'ready([{where(chosen.name, station)}])')
        Lines(loop, console.do, loop.stop if chosen.until_eof else None)
        keep_up(station)
        loop.run()
    except OSError as bad:
        sys.exit(f'brick.py: {bad}')
    finally:
        station.close()


def keep_up(station):
    """So that no telegram waits for all that has happened before it."""
    station.brick.advance(station.clock.now())
    station.loop.after(0.1, lambda: keep_up(station))


if __name__ == '__main__':
    main()
