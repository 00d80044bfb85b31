"""TCP proxies that cut, hold and delay, for the tests in this folder.

One process carries them all. It takes a command per line on its standard
input, answers each with a line, and ends with its input:

    listen NAME PORT TARGET     forward what comes to PORT to the port TARGET
    cut NAME fin|rst            close the connections that are open now
    after NAME up|down BYTES    forward so many more bytes, then close; once
    hold NAME up|down           forward nothing; what comes is kept
    release NAME up|down
    delay NAME up|down SECONDS  everything arrives so much later
    heal                        no more of all this
    counts                      connections made, cut, bytes: a Prolog term

Up is from the client to the target. Nothing is changed or reordered.
"""

import asyncio
import collections
import os
import socket
import struct
import sys

KEPT = 1 << 22          # bytes a direction keeps before it stops reading

counts = {"made": 0, "cut": 0, "bytes": 0}
proxies = {}


class Proxy:
    """What listens at one port, and the faults in force by direction."""

    def __init__(self, target):
        self.target = target
        self.held = set()
        self.delay = {}
        self.after = {}
        self.pairs = set()

    def move_on(self):
        for pair in list(self.pairs):
            for flow in pair.flows:
                flow.run()


class Pair:
    """A connection: two ends, and a flow from each to the other."""

    def __init__(self, proxy):
        counts["made"] += 1
        self.proxy = proxy
        self.client, self.target = End(self), End(self)
        self.flows = (Flow("up", self.client, self.target, proxy),
                      Flow("down", self.target, self.client, proxy))
        self.client.flow, self.target.flow = self.flows
        proxy.pairs.add(self)

    async def connect(self):
        try:
            await asyncio.get_running_loop().create_connection(
                lambda: self.target, "127.0.0.1", self.proxy.target)
        except OSError:
            self.close()
            return
        if self in self.proxy.pairs:
            self.flows[0].run()
        else:                                   # cut meanwhile
            self.target.transport.abort()

    def cut(self, reset):
        counts["cut"] += 1
        self.close(reset)

    def close(self, reset=False):
        self.proxy.pairs.discard(self)
        for end in (self.client, self.target):
            if end.transport is None:
                continue
            if reset:
                end.transport.get_extra_info("socket").setsockopt(
                    socket.SOL_SOCKET, socket.SO_LINGER,
                    struct.pack("ii", 1, 0))
            end.transport.abort()


class End(asyncio.Protocol):
    """One end of a connection; flow is what comes from it."""

    def __init__(self, pair):
        self.pair, self.flow, self.transport = pair, None, None
        self.writable = True

    def connection_made(self, transport):
        self.transport = transport
        if self is self.pair.client:
            self.task = asyncio.ensure_future(self.pair.connect())

    def data_received(self, data):
        self.flow.take(data)

    def eof_received(self):
        self.flow.take(b"")
        return True                             # the other flow goes on

    def connection_lost(self, _):
        self.pair.close()

    def pause_writing(self):
        self.writable = False

    def resume_writing(self):
        self.writable = True
        for flow in self.pair.flows:
            flow.run()


class Flow:
    """What goes from source to sink; an empty piece is the end of it."""

    def __init__(self, name, source, sink, proxy):
        self.name, self.source, self.sink, self.proxy = (name, source, sink,
                                                         proxy)
        self.pieces = collections.deque()       # when, bytes
        self.kept = 0
        self.timer = None
        self.ended = False

    def take(self, data):
        when = asyncio.get_running_loop().time()
        self.pieces.append((when + self.proxy.delay.get(self.name, 0), data))
        self.kept += len(data)
        self.run()
        if self.kept > KEPT and not self.source.transport.is_closing():
            self.source.transport.pause_reading()

    def free(self):
        return (self.sink.transport is not None and self.sink.writable
                and self.name not in self.proxy.held)

    def run(self):
        loop = asyncio.get_running_loop()
        while self.pieces and self.free():
            when, data = self.pieces[0]
            if when > loop.time():
                if self.timer is None:
                    self.timer = loop.call_at(when, self.wake)
                return
            self.pieces.popleft()
            self.kept -= len(data)
            self.forward(data)
        if self.kept <= KEPT and self.source.transport is not None:
            self.source.transport.resume_reading()

    def wake(self):
        self.timer = None
        self.run()

    def forward(self, data):
        if self.sink.transport.is_closing():
            return
        if not data:
            self.end()
            return
        left = self.proxy.after.get(self.name)
        if left is None:
            counts["bytes"] += len(data)
            self.sink.transport.write(data)
        elif left > len(data):
            self.proxy.after[self.name] = left - len(data)
            self.sink.transport.write(data)
        else:
            self.sink.transport.write(data[:left])
            del self.proxy.after[self.name]
            self.source.pair.cut(False)

    def end(self):
        self.ended = True
        try:
            self.sink.transport.write_eof()
        except OSError:                         # it was reset meanwhile
            self.source.pair.close()
            return
        if all(flow.ended for flow in self.source.pair.flows):
            self.source.transport.close()
            self.sink.transport.close()


async def command(verb, *args):
    if verb == "counts":
        return "counts(%(made)d, %(cut)d, %(bytes)d)" % counts
    if verb == "listen":
        await listen(args[0], int(args[1]), int(args[2]))
    elif verb == "heal":
        for proxy in proxies.values():
            proxy.held.clear()
            proxy.delay.clear()
            proxy.after.clear()
            proxy.move_on()
    else:
        fault(verb, proxies[args[0]], *args[1:])
    return "ok"


async def listen(name, port, target):
    proxy = proxies[name] = Proxy(target)
    await asyncio.get_running_loop().create_server(
        lambda: Pair(proxy).client, "127.0.0.1", port, backlog=256)


def fault(verb, proxy, what, number=0):
    if verb == "cut":
        for pair in list(proxy.pairs):
            pair.cut(what == "rst")
    elif verb == "after":
        proxy.after[what] = int(number)
    elif verb == "hold":
        proxy.held.add(what)
    elif verb == "release":
        proxy.held.discard(what)
    elif verb == "delay":
        proxy.delay[what] = float(number)
    else:
        raise ValueError(verb)
    proxy.move_on()


async def main():
    loop = asyncio.get_running_loop()
    orders = asyncio.StreamReader()
    await loop.connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(orders), sys.stdin)
    while line := await orders.readline():
        print(await command(*line.decode().split()) + ".", flush=True)
    os._exit(0)                                 # connections and all


if __name__ == "__main__":
    try:
        asyncio.run(main())
    except KeyboardInterrupt:
        pass
