"""The body of a robot: two driven wheels, a front, perhaps a clasp."""

import math

from .firmware import Brick
from .lanes import wrap

WHEEL = 0.056                   # diameter, metres
TRACK = 0.112
FRONT = 0.12                    # ahead of the axle
METRES_PER_DEGREE = math.pi * WHEEL / 360
A, B, C = range(3)

CLASP_OPEN, CLASP_CLOSED, CLASP_TOP = 0.0, 90.0, 270.0
CLASP_HOLDS = 80.0
LIFT = 0.12                     # metres

PLUGGED = {
    'plain': ('touch', 'sound', 'light', 'ultrasonic'),
    'carrier': ('touch', 'sound', 'light', 'ultrasonic'),
    'pusher': ('touch', 'compass', 'colour', 'colour'),
}


class Robot:
    def __init__(self, name, kind, pose, place=None, gains=(1, 1, 1),
                 number=1):
        """place: None, or [lane, metres along it, direction 1 or -1]"""
        if kind not in PLUGGED:
            raise ValueError(f'no such kind of robot: {kind}')
        self.name, self.kind = name, kind
        self.x, self.y, self.heading = pose
        self.place = place
        self.spin = 0.0         # off the direction of the lane, degrees
        self.steering = 0.0
        self.clasp = 0.0        # angle of motor A
        self.holding = False
        self.touching = False
        self.moved = 0.0        # metres driven forwards, for the record
        self.brick = Brick(name, PLUGGED[kind], gains, number, driven=True)
        if place:
            self.follow(0.0, None)

    # ---- where it is

    def front(self, ahead=FRONT, left=0.0):
        c = math.cos(math.radians(self.heading))
        s = math.sin(math.radians(self.heading))
        return (self.x + ahead * c - left * s, self.y + ahead * s + left * c)

    def height(self):
        rise = (self.clasp - CLASP_CLOSED) / (CLASP_TOP - CLASP_CLOSED)
        return LIFT * max(0.0, min(1.0, rise))

    def clasp_state(self):
        if self.holding:
            return 'holding'
        return 'closed' if self.clasp >= CLASP_HOLDS else 'open'

    # ---- one step: what the motors would do, then what is possible

    def wish(self, dt):
        """Metres forwards if nothing is in the way; may be negative."""
        self.turning = self.brick.motors.wish(dt)
        left, right = (self.turning[m] * METRES_PER_DEGREE for m in (B, C))
        most = max(abs(left), abs(right))
        self.steering = (right - left) / most if most else 0.0
        self.wheels = (left, right)
        return (left + right) / 2

    def apply(self, freely, lanes):
        """Drives the part of the wish that is free, 0 to 1."""
        left, right = (w * freely for w in self.wheels)
        if self.place:
            freely = self.drive_lane(left, right, freely, lanes)
        else:
            self.drive(left, right)
        clasp = self.move_clasp()
        self.brick.motors.turn(self.turning, (clasp, freely, freely))

    def drive(self, left, right):
        ahead, turn = (left + right) / 2, (right - left) / TRACK
        middle = math.radians(self.heading) + turn / 2
        self.x += ahead * math.cos(middle)
        self.y += ahead * math.sin(middle)
        self.heading = wrap(self.heading + math.degrees(turn))
        self.moved += ahead

    def move_clasp(self):
        """Motor A stalls at the stops of the clasp; other kinds have none."""
        wish = self.turning[A]
        if self.kind != 'carrier' or not wish:
            return 1.0
        free = max(CLASP_OPEN, min(CLASP_TOP, self.clasp + wish))
        part = (free - self.clasp) / wish
        self.clasp = free
        return part

    # ---- on a lane

    def drive_lane(self, left, right, freely, lanes):
        if left * right < 0:            # turns on the spot
            self.spin += math.degrees((right - left) / TRACK)
            if abs(self.spin) > 90:
                self.place[2] = -self.place[2]
                self.spin = wrap(self.spin + 180)
            ahead = 0.0
        else:
            ahead = (left + right) / 2
            self.spin *= max(0.0, 1 - abs(ahead) / 0.03)
        return freely if self.follow(ahead, lanes) else 0.0

    def follow(self, ahead, lanes):
        """Along the lane and into the next; False at a dead end."""
        lane, s, way = self.place
        s += ahead * way
        on = 0.0 <= s <= lane.length
        if not on:
            end = lane.length if s > 0 else 0.0
            branch = lanes.choose(lane, end, self.steering)
            if branch:
                over = abs(s - end)
                lane, start, travel, _ = branch
                s = start + over * travel
                way = travel if ahead > 0 else -travel
            else:
                s = end
        self.place = [lane, s, way]
        self.x, self.y, direction = lane.at(s)
        self.heading = wrap(direction + (0 if way > 0 else 180) + self.spin)
        if on or branch:
            self.moved += ahead
        return on or bool(branch)
