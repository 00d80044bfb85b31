#!/usr/bin/env python3
"""A world for simulated NXT bricks: every robot in it has one of its own.

    python3 bridges/nxt/world.py bridges/nxt/scenes/pole.json --pty DIR

When it is ready it prints a line that says where the bricks are; lines on
standard input ask for the state and change the world. See doc/robot-studies.md."""

import argparse
import json
import os
import sys
import time

from simulation import drawing, faults
from simulation.arena import Arena
from simulation.clock import Clock
from simulation.console import Console, terms, where
from simulation.line import Station
from simulation.loop import Lines, Loop, say
from simulation.recorder import Recorder, moment

TICK = 0.02                     # seconds of the host
MOST_LATE = 0.1                 # seconds of the host


class World:
    def __init__(self, chosen, scene, loop):
        self.loop, self.chosen = loop, chosen
        self.clock = Clock(chosen.clock)
        self.stepped = time.monotonic()
        self.arena = Arena(scene, chosen.seed)
        log = open(chosen.log, 'w', encoding='utf-8') if chosen.log else None
        self.recorder = Recorder(self.arena, chosen.every, log)
        self.frames = 0
        self.stations, self.consoles = {}, {}
        for robot in self.arena.robots.values():
            self.connect(robot)

    # ---- bricks

    def connect(self, robot):
        station = Station(self.loop, self.clock, robot.brick,
                          faults.Faults(), self.chosen.seed)

        def look():
            self.step()
            self.arena.look(robot)

        def before():
            self.clock.advance(self.chosen.telegram)
            look()
        station.before = before
        self.stations[robot.name] = station
        self.consoles[robot.name] = Console(station, look)
        link = self.chosen.pty and os.path.join(self.chosen.pty, robot.name)
        port = self.chosen.tcp
        if port:
            port += len(self.stations) - 1
        station.open(link, port)
        return station

    def places(self):
        return [where(n, s) for n, s in self.stations.items()]

    def close(self):
        for station in self.stations.values():
            station.close()

    # ---- time

    def step(self):
        """Where the host is too busy to keep up, time slips: the bricks
        must answer, and nothing should move on unobserved."""
        last, self.stepped = self.stepped, time.monotonic()
        late = self.stepped - last - MOST_LATE
        if late > 0:
            self.clock.advance(-late * self.clock.rate)
        self.arena.advance(self.clock.now())
        if self.chosen.frames:
            self.draw_frames()

    def keep_up(self):
        self.step()
        self.loop.after(TICK, self.keep_up)

    def draw_frames(self):
        moments = self.recorder.moments
        while self.frames < len(moments):
            file = f'{self.chosen.frames}/frame-{self.frames:05d}.svg'
            drawing.save(file, drawing.frame(self.arena,
                                             moments[self.frames]))
            self.frames += 1

    # ---- lines

    def do(self, words):
        command = getattr(self, 'do_' + words[0], None)
        if command is None:
            raise ValueError('no such command: ' + words[0])
        if words[0] != 'quit':
            self.step()
        return command(*words[1:])

    def do_brick(self, name, *words):
        if name not in self.consoles or not words:
            raise ValueError(f'no such brick or no command: {name}')
        return self.consoles[name].do(list(words))

    def do_state(self):
        return self.arena.term()

    def do_events(self):
        self.recorder.log_events()
        found = [f'event({t:.3f}, {what})'
                 for t, what in self.arena.take_events()]
        return f'events({terms(found)})'

    def do_robot(self, name, *words):
        if words[:1] == ('lane',):
            _, lane, metres, kind, *way = words
            place = [lane, float(metres), *map(int, way)]
            robot = self.arena.add_robot(name, kind, lane=place)
        else:
            x, y, heading, kind = words
            robot = self.arena.add_robot(
                name, kind, (float(x), float(y), float(heading)))
        return where(name, self.connect(robot))

    def do_box(self, name, x, y, heading, needs, distance):
        self.arena.add_box(name, (float(x), float(y), float(heading)),
                           needs, distance)
        return 'ok'

    def do_remove(self, name):
        if self.arena.remove(name):
            self.stations.pop(name).close()
            del self.consoles[name]
        return 'ok'

    def do_frame(self, file):
        drawing.save(file, drawing.frame(self.arena, moment(self.arena)))
        return 'ok'

    def do_picture(self, file):
        now = moment(self.arena)
        drawing.save(file, drawing.picture(self.arena,
                                           self.recorder.moments + [now]))
        return 'ok'

    def do_time(self):
        return f'time({self.arena.time:.3f})'

    def do_advance(self, seconds):
        if float(seconds) < 0:
            raise ValueError('time does not go back')
        self.clock.advance(float(seconds))
        self.step()
        return 'ok'

    def do_until(self, seconds):
        """Telegrams may have taken the clock beyond that already."""
        self.clock.advance(max(0.0, float(seconds) - self.clock.now()))
        self.step()
        return 'ok'

    def do_bricks(self):
        return f'bricks({terms(self.places())})'

    def do_quit(self):
        self.loop.stop()
        return 'ok'


def options():
    parser = argparse.ArgumentParser(
        description='A world for simulated NXT bricks.', allow_abbrev=False)
    add = parser.add_argument
    add('scene', metavar='SCENE.json', help='what is in it')
    add('--pty', metavar='DIR', help='a link per robot in this directory')
    add('--tcp', metavar='PORT', type=int,
        help='port of the first brick, the next has the next; 0: any')
    add('--clock', metavar='RATE', type=float, default=1.0,
        help='seconds per second; 0: only by "advance SECONDS"')
    add('--telegram', metavar='S', type=float, default=0.0,
        help='seconds that each telegram takes, beside those of the clock')
    add('--seed', type=int, default=0)
    add('--log', metavar='FILE', help='of states and events')
    add('--every', metavar='S', type=float, default=0.2,
        help='seconds from one recorded state to the next')
    add('--frames', metavar='DIR', help='a picture of every recorded state')
    add('--picture', metavar='FILE', help='the run as one moving picture')
    add('--until-eof', action='store_true',
        help='end when standard input ends')
    return parser.parse_args()


def main():
    chosen = options()
    loop = Loop()
    loop.stop_on_signals()
    world = None
    try:
        with open(chosen.scene, encoding='utf-8') as file:
            scene = json.load(file)
        for folder in filter(None, (chosen.pty, chosen.frames)):
            os.makedirs(folder, exist_ok=True)
        world = World(chosen, scene, loop)
        say(f'ready({terms(world.places())})')
        Lines(loop, world.do, loop.stop if chosen.until_eof else None)
        world.keep_up()
        loop.run()
        if chosen.picture:
            world.do_picture(chosen.picture)
    except (OSError, ValueError, KeyError, TypeError) as bad:
        sys.exit(f'world.py: {type(bad).__name__}: {bad}')
    finally:
        if world:
            world.close()


if __name__ == '__main__':
    main()
