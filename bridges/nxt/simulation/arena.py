"""A flat arena: robots, a pole, boxes, lines and markers.

It moves in steps of equal length, so that a run depends only on the seed
and on the commands of the motors at each step."""

import math
import random

from .box import Box
from .firmware import STEP
from .lanes import Lanes
from .pole import Pole
from .robot import Robot
from .senses import Floor, sense

SPREAD = 0.03                   # of the strength of motors
MARGIN = 0.05                   # of a robot to the walls


class Arena:
    def __init__(self, scene, seed=0):
        self.seed = seed
        self.time = 0.0
        self.steps = 0
        self.size = tuple(scene.get('size', (4.0, 3.0)))
        self.lanes = Lanes(scene.get('lanes', {}))
        self.markers = scene.get('markers', [])
        self.lines = ([lane.points for lane in self.lanes.lanes.values()]
                      + [[tuple(p) for p in line]
                         for line in scene.get('lines', [])])
        self.floor = Floor(self.lines, self.markers)
        pole = scene.get('pole')
        self.pole = pole and Pole(pole['from'], pole['to'],
                                  pole.get('limit', 8.0), pole.get('drop_at'))
        self.robots, self.boxes, self.events = {}, {}, []
        self.made = 0
        self.after_step = lambda: None  # the recorder
        for robot in scene.get('robots', []):
            self.add_robot(robot['name'], robot.get('kind', 'plain'),
                           robot.get('at'), robot.get('lane'))
        for box in scene.get('boxes', []):
            self.add_box(box['name'], box['at'], box['needs'],
                         box['distance'])
        self.events = []

    def tell(self, what):
        self.events.append((self.time, what))

    # ---- what is in it

    def add_robot(self, name, kind, at=None, lane=None):
        """at: x, y, heading; or lane: name, metres, direction (1 or -1)"""
        self.new_name(name)
        chance = random.Random(f'{self.seed} {name}')
        gains = [1 + chance.uniform(-SPREAD, SPREAD) for _ in range(3)]
        place = None
        if lane:
            line = self.lanes[lane[0]]
            way = lane[2] if len(lane) > 2 else 1
            if not 0 <= lane[1] <= line.length or way not in (1, -1):
                raise ValueError(f'not on lane {lane[0]}: {lane[1:]}')
            place = [line, float(lane[1]), way]
            at = (0.0, 0.0, 0.0)
        if not at:
            raise ValueError(f'{name}: at or lane')
        self.made += 1
        robot = Robot(name, kind, tuple(at), place, gains, self.made)
        robot.random, robot.shut = chance, False
        robot.brick.time = self.time
        for port in robot.brick.inputs:
            port.valid_at += self.time
        self.robots[name] = robot
        self.tell(f'added({name})')
        return robot

    def add_box(self, name, at, needs, distance):
        self.new_name(name)
        self.boxes[name] = Box(name, tuple(at), int(needs), float(distance))
        self.tell(f'added({name})')

    def new_name(self, name):
        plain = name.isidentifier() and name[0].islower() and name.isascii()
        if not plain:
            raise ValueError(f'no name: {name}')
        if name in self.robots or name in self.boxes:
            raise ValueError(f'there is a {name} already')

    def remove(self, name):
        if name not in self.robots and name not in self.boxes:
            raise ValueError(f'there is no {name}')
        self.boxes.pop(name, None)
        self.tell(f'removed({name})')
        return self.robots.pop(name, None)

    # ---- time

    def advance(self, now):
        """In steps up to now; while nothing turns it jumps."""
        while self.time + STEP <= now:
            if self.at_rest():
                whole = self.stretch(now)
                self.steps += whole
            else:
                self.step()
                self.steps += 1
            self.time = self.steps * STEP
            for robot in self.robots.values():
                robot.brick.tick(self.time)
            self.after_step()

    def stretch(self, now):
        """Steps that can be taken in one."""
        return max(1, min(20, int((now - self.time) / STEP + 1e-6)))

    def at_rest(self):
        return (all(r.brick.motors.at_rest() for r in self.robots.values())
                and all(b.state != 'moving' for b in self.boxes.values()))

    def step(self):
        wishes = [(r, r.wish(STEP)) for r in self.robots.values()]
        free = {r.name: self.free(r, ahead) for r, ahead in wishes}
        for box in self.boxes.values():
            for robot, part in box.push(wishes, self.time, self.tell):
                free[robot.name] = min(free[robot.name], part)
        for robot, _ in wishes:
            robot.apply(free[robot.name], self.lanes)
            robot.touching = any(box.touched(robot)
                                 for box in self.boxes.values())
        if self.pole:
            robots = list(self.robots.values())
            self.pole.clasp(robots, self.tell)
            self.pole.settle(robots, self.tell)

    def free(self, robot, ahead):
        """The part of the way ahead that walls and the pole leave."""
        angle = math.radians(robot.heading)
        x = robot.x + ahead * math.cos(angle)
        y = robot.y + ahead * math.sin(angle)
        inside = (MARGIN <= x <= self.size[0] - MARGIN
                  and MARGIN <= y <= self.size[1] - MARGIN)
        if not inside and self.outwards(robot, x, y):
            return 0.0
        return self.pole.free(robot, ahead) if self.pole else 1.0

    def outwards(self, robot, x, y):
        middle = (self.size[0] / 2, self.size[1] / 2)
        return (abs(x - middle[0]) > abs(robot.x - middle[0])
                or abs(y - middle[1]) > abs(robot.y - middle[1]))

    def look(self, robot):
        sense(self, robot)

    # ---- as a Prolog term

    def term(self):
        robots = ', '.join(robot_term(r) for r in self.robots.values())
        boxes = ', '.join(box_term(b) for b in self.boxes.values())
        pole = pole_term(self.pole) if self.pole else 'none'
        return f'state({self.time:.3f}, [{robots}], {pole}, [{boxes}])'

    def take_events(self):
        events, self.events = self.events, []
        return events


def robot_term(r):
    return (f'robot({r.name}, {r.x:.4f}, {r.y:.4f}, {r.heading:.2f}, '
            f'{r.clasp_state()}, {r.height():.4f}, {int(r.touching)})')


def pole_term(p):
    x, y = p.centre()
    return (f'pole({x:.4f}, {y:.4f}, {p.height():.4f}, {p.pitch:.3f}, '
            f'{p.yaw:.3f}, {p.tilt:.3f}, {p.most:.3f}, {p.strain:.4f}, '
            f'{p.phase})')


def box_term(b):
    return (f'box({b.name}, {b.x:.4f}, {b.y:.4f}, {b.needs}, '
            f'{len(b.pushing)}, {b.state})')
