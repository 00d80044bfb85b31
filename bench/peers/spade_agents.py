"""SPADE's agents for bench/peers.pl.

    python spade_agents.py start | idle | messages

The XMPP server is SPADE's own, pyjabber, in the first process. Agents of one
process pass messages without it. The other process has the agents remote0 to
remote9. Fewer agents are idle than on other platforms: each has a connection,
and the creation of an agent takes a tenth of a second.
"""

import asyncio
import logging
import multiprocessing
import os
import platform
import socket
import sys

import loguru
import spade
from pyjabber.server import Server
from pyjabber.server_parameters import Parameters
from spade.agent import Agent
from spade.behaviour import CyclicBehaviour, OneShotBehaviour
from spade.container import Container
from spade.message import Message

from bench import TEXT, measured, tell

port = None


def free_ports():
    sockets = [socket.socket() for _ in range(2)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


async def serve():
    """Starts the server, on the loopback interface only, without its pages."""
    global port
    port, other = free_ports()
    server = Server(Parameters(
        host="localhost", client_port=port, server_port=other,
        database_in_memory=True))
    server._public_ip = server._http_server = None
    asyncio.create_task(server.start())
    await server.ready.wait()


class Pong(CyclicBehaviour):
    async def run(self):
        message = await self.receive(timeout=60)
        if message:
            await self.send(message.make_reply())


class Answer(OneShotBehaviour):
    async def run(self):
        message = await self.receive(timeout=60)
        await self.send(message.make_reply())


class Ask(OneShotBehaviour):
    """Sends count messages, each when the one before was answered. The
    server drops messages for agents that it does not know to be there yet:
    one is sent again if there is no answer."""

    def __init__(self, to, count):
        super().__init__()
        self.to, self.count = to, count

    async def run(self):
        for _ in range(self.count):
            await self.ask(self.to)

    async def ask(self, to):
        answer = None
        while not answer:
            await self.send(Message(to=to, body=TEXT))
            answer = await self.receive(timeout=5)


class AskNew(Ask):
    """Sends each message to an agent that it creates."""

    async def run(self):
        for i in range(self.count):
            agent = await create(f"{self.to}{i}", Answer())
            await self.ask(str(agent.jid))
            await agent.stop()


async def create(name, behaviour=None):
    agent = Agent(f"{name}@localhost", "secret", port=port)
    for i in range(1, 11):
        agent.set(f"fact{i}", i)
    if behaviour:
        agent.add_behaviour(behaviour)
    await agent.start()
    return agent


async def answers(name, count):
    ask = AskNew(name, count)
    await create(f"asker-{name}", ask)
    await ask.join()


async def pongs(where):
    for i in range(10):
        await create(f"{where}{i}", Pong())


async def pairs(where, agents, messages):
    await paired(where, agents[:1], 40)         # warm up
    with measured(f"{where}(one)", messages):
        await paired(where, agents[:1], messages)
    with measured(f"{where}(ten)", 2 * messages):
        await paired(where, agents, 2 * messages)


async def paired(where, agents, messages):
    asks = [Ask(f"{where}{i}@localhost", messages // (2 * len(agents)))
            for i in range(len(agents))]
    for agent, ask in zip(agents, asks):
        agent.add_behaviour(ask)
    for ask in asks:
        await ask.join()


async def other():
    """Runs the other process; it ends with its standard input."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, __file__, "there", str(port),
        stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE)
    await process.stdout.readline()
    return process


async def main():
    global port
    part = sys.argv[1]
    if part == "there":
        port = int(sys.argv[2])
        await pongs("remote")
        print("ready", flush=True)
        await asyncio.to_thread(sys.stdin.read)
        return
    await serve()
    if part == "start":
        await answers("first", 1)
        tell("done(start, 1)")
        tell(f"version('SPADE {spade.__version__}, "
             f"Python {platform.python_version()}')")
    elif part == "idle":
        await create("first")
        with measured("memory", 100):
            for i in range(100):
                await create(f"idle{i}", Pong())
    else:
        agents = [await create(f"ping{i}") for i in range(10)]
        await pongs("local")
        await pairs("local", agents, 2000)
        process = await other()
        await pairs("remote", agents, 400)
        process.stdin.close()
        await process.wait()
        with measured("answers", 5):
            await answers("answerer", 5)


logging.disable()
loguru.logger.remove()
Container().run(main())
for child in multiprocessing.active_children():     # the server's
    child.kill()
os._exit(0)                             # its tasks do not end
