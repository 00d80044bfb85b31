"""Lines that robots follow, and the places where they meet."""

import math

SAME_PLACE = 0.005              # metres
STEERING = 0.1                  # difference of the wheels that chooses


class Lane:
    def __init__(self, name, points):
        self.name = name
        self.points = [tuple(p) for p in points]
        self.starts = [0.0]
        for (x0, y0), (x1, y1) in zip(self.points, self.points[1:]):
            self.starts.append(self.starts[-1] + math.hypot(x1 - x0, y1 - y0))
        self.length = self.starts[-1]

    def piece(self, s):
        for i in range(len(self.points) - 2):
            if s < self.starts[i + 1]:
                return i
        return len(self.points) - 2

    def at(self, s):
        """x, y and the direction in degrees at s metres."""
        s = max(0.0, min(self.length, s))
        i = self.piece(s)
        (x0, y0), (x1, y1) = self.points[i:i + 2]
        part = (s - self.starts[i]) / (self.starts[i + 1] - self.starts[i])
        way = math.degrees(math.atan2(y1 - y0, x1 - x0))
        return x0 + part * (x1 - x0), y0 + part * (y1 - y0), way


class Lanes:
    def __init__(self, lanes):
        self.lanes = {name: Lane(name, points)
                      for name, points in lanes.items()}

    def __getitem__(self, name):
        return self.lanes[name]

    def branches(self, lane, end):
        """(lane, its start, direction of travel, turn) from an end of lane.

        end is 0 or the length of the lane."""
        x, y, way = lane.at(end)
        if not end:
            way += 180
        found = []
        for other in self.lanes.values():
            for start, travel in ((0.0, 1), (other.length, -1)):
                if other is lane and start == end:
                    continue
                ox, oy, out = other.at(start)
                if math.hypot(ox - x, oy - y) < SAME_PLACE:
                    turn = wrap(out + (0 if travel > 0 else 180) - way)
                    found.append((other, start, travel, turn))
        return found

    def choose(self, lane, end, steering):
        """The branch to the left if steering is positive, to the right if
        it is negative, else the straightest; None at a dead end."""
        found = self.branches(lane, end)
        if not found:
            return None
        if steering > STEERING:
            return max(found, key=lambda b: b[3])
        if steering < -STEERING:
            return min(found, key=lambda b: b[3])
        return min(found, key=lambda b: abs(b[3]))


def wrap(degrees):
    """Into -180 to 180."""
    return (degrees + 180) % 360 - 180
