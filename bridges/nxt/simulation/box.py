"""A box that moves, one way only, while enough robots push it."""

import math

DEPTH = 0.2                     # metres, in the direction of the push
LANE = 0.16                     # width for each robot that is needed
TOUCH = 0.002
ALIGNED = math.cos(math.radians(30))
STILL = 0.3                     # seconds after which it has stopped


class Box:
    def __init__(self, name, pose, needs, distance):
        self.name, self.needs, self.distance = name, needs, distance
        self.x, self.y, self.heading = pose     # middle of its near face
        self.width = LANE * max(1, needs)
        way = math.radians(self.heading)
        self.way = (math.cos(way), math.sin(way))
        self.done = 0.0         # metres
        self.moved_at = None
        self.state = 'waiting'
        self.pushing = []

    def gap(self, robot):
        """From the front of a robot behind it to its near face, or None."""
        fx, fy = robot.front()
        dx, dy = self.x - fx, self.y - fy
        ahead = dx * self.way[0] + dy * self.way[1]
        aside = abs(dx * self.way[1] - dy * self.way[0])
        turn = math.radians(robot.heading - self.heading)
        if aside > self.width / 2 or math.cos(turn) < ALIGNED:
            return None
        return ahead if ahead > -TOUCH * 5 else None

    def push(self, wishes, time, tell):
        """wishes: [(robot, metres ahead)]. Moves the box, and gives the
        part of its wish that is left to each robot that meets it."""
        met = []
        for robot, ahead in wishes:
            gap = self.gap(robot)
            if gap is not None and ahead > 0 and ahead > gap:
                met.append((robot, ahead, max(0.0, gap)))
        self.pushing = [robot.name for robot, _, _ in met]
        step = 0.0
        if len(met) >= self.needs and self.state != 'arrived':
            step = min(ahead - gap for _, ahead, gap in met)
            step = min(step, self.distance - self.done)
        self.move(step, time, tell)
        return [(robot, min(1.0, (gap + step) / ahead))
                for robot, ahead, gap in met]

    def move(self, step, time, tell):
        self.x += step * self.way[0]
        self.y += step * self.way[1]
        self.done += step
        if step > 0:
            self.moved_at = time
            if self.state == 'waiting':
                self.state = 'moving'
                tell(f'pushed({self.name})')
        if self.state == 'moving':
            if self.done >= self.distance - 1e-9:
                self.state = 'arrived'
                tell(f'arrived({self.name})')
            elif time - self.moved_at > STILL:
                self.state = 'waiting'
                tell(f'stopped({self.name})')

    def touched(self, robot):
        gap = self.gap(robot)
        return gap is not None and gap <= TOUCH

    def corners(self):
        (c, s), half = self.way, self.width / 2
        return [(self.x + d * c - w * s, self.y + d * s + w * c)
                for d, w in ((0, -half), (0, half), (DEPTH, half),
                             (DEPTH, -half))]
