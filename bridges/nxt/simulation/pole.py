"""A long pole that several robots clasp, lift and carry.

In the frame of the pole as it lay at first, u runs along it and n across,
the way in which the robots come. It is stiff: it lies on the highest of its
supports, and its course is the line that fits the clasps best."""

import math

from .robot import CLASP_HOLDS

TOUCH = 0.003                   # metres
IN_REACH = 0.02
CLEAR = 0.005                   # height above which it is off the ground
FALLS = 0.03


class Pole:
    def __init__(self, begin, end, limit=8.0, drop_at=None):
        (x0, y0), (x1, y1) = begin, end
        self.length = math.hypot(x1 - x0, y1 - y0)
        if not self.length:
            raise ValueError('a pole has a length')
        self.origin = (x0, y0)
        self.u = ((x1 - x0) / self.length, (y1 - y0) / self.length)
        self.n = (-self.u[1], self.u[0])
        self.limit, self.drop_at = limit, drop_at
        self.offset, self.slope = 0.0, 0.0      # n = offset + slope * u
        self.pitch = self.yaw = self.tilt = self.most = self.strain = 0.0
        self.low, self.high = 0.0, 0.0          # heights of both ends
        self.phase = 'lying'
        self.over = self.off_ground = False

    # ---- places

    def local(self, point):
        dx, dy = point[0] - self.origin[0], point[1] - self.origin[1]
        return (dx * self.u[0] + dy * self.u[1],
                dx * self.n[0] + dy * self.n[1])

    def place(self, along):
        across = self.offset + self.slope * along
        return (self.origin[0] + along * self.u[0] + across * self.n[0],
                self.origin[1] + along * self.u[1] + across * self.n[1])

    def ends(self):
        return self.place(0.0), self.place(self.length)

    def centre(self):
        return self.place(self.length / 2)

    def height(self):
        return (self.low + self.high) / 2

    # ---- contact

    def gap(self, robot):
        """How far it is ahead of the front of a robot that faces it; None
        if it is out of the way."""
        along, across = self.local(robot.front())
        if not 0 <= along <= self.length:
            return None
        way = math.radians(robot.heading)
        facing = math.cos(way) * self.n[0] + math.sin(way) * self.n[1]
        gap = self.offset + self.slope * along - across
        return gap / facing if facing > 0.7 and gap > -IN_REACH else None

    def free(self, robot, ahead):
        """The part of the way ahead that the pole leaves to a robot."""
        if ahead <= 0 or robot.holding:
            return 1.0
        gap = self.gap(robot)
        if gap is None or gap >= ahead:
            return 1.0
        return max(0.0, gap) / ahead

    def touched(self, robot):
        if robot.holding:
            return True
        gap = self.gap(robot)
        return gap is not None and abs(gap) <= TOUCH

    # ---- after every step

    def clasp(self, robots, tell):
        for robot in robots:
            if robot.kind != 'carrier':
                continue
            shut = robot.clasp >= CLASP_HOLDS
            if robot.holding and not shut:
                robot.holding = False
                tell(f'released({robot.name})')
            elif shut and not robot.shut and self.touched(robot):
                robot.holding = True
                tell(f'clasped({robot.name})')
            robot.shut = shut
            robot.touching = self.touched(robot)

    def settle(self, robots, tell):
        holders = [(self.local(r.front()), r.height())
                   for r in robots if r.holding]
        before = self.height()
        across = self.fit([at for at, _ in holders])
        upright = self.rest([(at[0], h) for at, h in holders])
        self.strain = max(across, upright)
        self.yaw = math.degrees(math.atan(self.slope))
        self.tilt = math.degrees(math.acos(
            math.cos(math.radians(self.pitch))
            * math.cos(math.radians(self.yaw))))
        self.judge(bool(holders), before, tell)
        if self.drop_at is not None and self.tilt > self.drop_at and holders:
            self.drop(robots, tell)

    def fit(self, points):
        """Lays the course through the clasps; how far they are off it."""
        if not points:
            return 0.0
        mean_u = sum(u for u, _ in points) / len(points)
        mean_n = sum(n for _, n in points) / len(points)
        spread = sum((u - mean_u) ** 2 for u, _ in points)
        if spread > 1e-6:
            self.slope = sum((u - mean_u) * (n - mean_n)
                             for u, n in points) / spread
        self.offset = mean_n - self.slope * mean_u
        return max(abs(n - self.offset - self.slope * u) for u, n in points)

    def rest(self, clasps):
        """Lays it on the two supports that hold its centre highest."""
        centre = self.length / 2
        supports = [(0.0, 0.0), (self.length, 0.0)] + clasps
        best = (0.0, 0.0, 0.0)          # height of the centre, slope
        for u0, h0 in supports:
            for u1, h1 in supports:
                if u0 < centre <= u1:
                    slope = (h1 - h0) / (u1 - u0)
                    best = max(best, (h0 + slope * (centre - u0),
                                      -abs(slope), slope))
        middle, _, slope = best
        self.pitch = math.degrees(math.atan(slope))
        self.low = middle - slope * centre
        self.high = middle + slope * centre
        return max((abs(self.low + slope * u - h) for u, h in clasps),
                   default=0.0)

    def judge(self, held, before, tell):
        if held:
            self.most = max(self.most, self.tilt)
        up = self.height() > CLEAR
        if up != self.off_ground:
            fell = not up and not held and before > FALLS
            tell('lifted(pole)' if up else
                 'dropped(pole)' if fell else 'lowered(pole)')
        self.off_ground = up
        if self.phase != 'dropped':
            self.phase = ('carried' if up else 'held' if held else 'lying')
        if self.over and self.tilt < self.limit - 0.5:
            self.over = False
        elif not self.over and self.tilt > self.limit and held:
            self.over = True
            tell(f'over_limit({self.tilt:.2f})')

    def drop(self, robots, tell):
        for robot in robots:
            robot.holding = False
        self.rest([])
        self.off_ground = False
        self.phase = 'dropped'
        tell('dropped(pole)')
