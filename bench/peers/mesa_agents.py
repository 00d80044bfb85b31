"""Mesa's agents for bench/peers.pl.

    python mesa_agents.py start | idle | walks

Mesa has one process, in which agents call methods of each other: it has no
messages. A walking agent changes its attribute `cell` to a random neighbour on
a grid of 30 cells, in each step of the model. The first agent has answered
when a method was called.
"""

import gc
import platform
import random
import sys

import mesa
from mesa.discrete_space import CellAgent, OrthogonalVonNeumannGrid

from bench import measured, tell


class Walker(CellAgent):
    def __init__(self, model):
        super().__init__(model)
        self.cell = model.grid.all_cells.select_random_cell()
        self.facts = {f"fact{i}": i for i in range(1, 11)}

    def step(self):
        self.cell = self.cell.neighborhood.select_random_cell()


class World(mesa.Model):
    def __init__(self, agents):
        super().__init__(seed=1)
        self.grid = OrthogonalVonNeumannGrid(
            (5, 6), torus=False, random=random.Random(1))
        Walker.create_agents(self, agents)

    def step(self):
        self.agents.do("step")


def walks(agents, moves):
    world = World(agents)
    for _ in range(moves // agents):
        world.step()


part = sys.argv[1]
if part == "start":
    walks(1, 1)
    tell("done(start, 1)")
    tell(f"version('Mesa {mesa.__version__}, "
         f"Python {platform.python_version()}')")
elif part == "idle":
    gc.collect()
    with measured("memory", 10000):
        world = World(10000)
else:
    walks(1, 1000)                      # warm up
    with measured("walks(one)", 20000):
        walks(1, 20000)
    with measured("walks(ten)", 40000):
        walks(10, 40000)
