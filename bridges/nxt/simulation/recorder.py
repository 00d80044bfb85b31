"""Remembers a run, for pictures of it and for a log."""


class Recorder:
    def __init__(self, arena, every=0.2, log=None):
        self.arena, self.every, self.log = arena, every, log
        self.moments = []
        self.told = 0
        self.due = 0.0
        arena.after_step = self.step
        self.step()

    def step(self):
        self.log_events()
        if self.arena.time + 1e-9 >= self.due:
            self.due = self.arena.time + self.every
            self.moments.append(moment(self.arena))
            self.write(self.arena.term())

    def log_events(self):
        events = self.arena.events
        if len(events) < self.told:
            self.told = 0               # they have been taken
        for time, what in events[self.told:]:
            self.write(f'event({time:.3f}, {what})')
        self.told = len(events)

    def write(self, term):
        if self.log:
            self.log.write(term + '.\n')
            self.log.flush()


def moment(arena):
    pole = arena.pole
    return {
        'time': arena.time,
        'robots': {r.name: (r.x, r.y, r.heading, r.kind, r.touching,
                            r.clasp_state(), r.height())
                   for r in arena.robots.values()},
        'boxes': {b.name: (b.corners(), b.needs, len(b.pushing), b.state)
                  for b in arena.boxes.values()},
        'pole': pole and (pole.ends(), pole.low, pole.high, pole.tilt,
                          pole.tilt > pole.limit),
    }
