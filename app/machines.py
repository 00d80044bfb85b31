#!/usr/bin/env python3
"""Run a command beside machines of its own, which it reaches by ssh.

    python3 app/machines.py --delay 1,2,4 --loss 0,0.5 8 swipl prolog/typhon.pl

Each machine is a network namespace with an ssh daemon, at 10.213.78.1,
10.213.78.2 and so on; the command has 10.213.78.254, and no other network.
The environment of the command names them: TYPHON_MACHINES, TYPHON_BIND.
Packets between them pass this program, which delays and drops them. It is the
first process of a process namespace: if it ends, the kernel ends all others,
and nothing is left, also after kill -9. The keys are in a file system of the
namespace.

Root needs no other rights; other users need user namespaces.
"""

import argparse
import collections
import contextlib
import ctypes
import fcntl
import heapq
import itertools
import os
import random
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time

NET = '10.213.78.'
HERE = NET + '254'
PORT = 2222
FILES = '/dev/shm/machines'
UNAVAILABLE = 69                        # of sysexits.h

# Of linux/sched.h, linux/mount.h, linux/prctl.h, linux/sockios.h, linux/if.h
# and linux/if_tun.h; Python has unshare since 3.12.
NEWNS, NEWUTS, NEWUSER = 0x20000, 0x4000000, 0x10000000
NEWPID, NEWNET = 0x20000000, 0x40000000
MS_REC, MS_PRIVATE = 0x4000, 0x40000
PR_SET_PDEATHSIG = 1
SIOCSIFFLAGS, SIOCSIFADDR, SIOCSIFNETMASK = 0x8914, 0x8916, 0x891c
IFF_UP = 1
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454ca, 0x1, 0x1000

LIBC = ctypes.CDLL(None, use_errno=True)

Machine = collections.namedtuple('Machine', 'address wire delay loss')


class Unavailable(Exception):
    """This system does not permit such machines; the text says why."""


def system(name, *arguments):
    """Call a function of libc, which returns -1 if it fails."""
    if getattr(LIBC, name)(*arguments) == -1:
        code = ctypes.get_errno()
        raise OSError(code, '%s: %s' % (name, os.strerror(code)))


# ---------------------------------------------------------------- namespaces

def die_with(parent):
    """The kernel kills this process when its parent ends."""
    system('prctl', PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


def enter_namespaces():
    """Make namespaces, of which the next child is the first process."""
    user, group = os.geteuid(), os.getegid()
    try:
        system('unshare',
               NEWNS | NEWPID | NEWUTS | (NEWUSER if user != 0 else 0))
        if user != 0:
            for name, text in (('setgroups', 'deny'),
                               ('uid_map', '%d %d 1' % (user, user)),
                               ('gid_map', '%d %d 1' % (group, group))):
                with open('/proc/self/' + name, 'w', encoding='ascii') as file:
                    file.write(text)
    except OSError as error:
        raise Unavailable(
            'namespaces are not permitted here (%s): be root, or permit them,'
            ' by sysctl kernel.unprivileged_userns_clone=1, on Ubuntu'
            ' kernel.apparmor_restrict_unprivileged_userns=0' % error) from error


def mount_own():
    """Process numbers, and files, of the namespaces alone."""
    try:
        system('mount', None, b'/', None, MS_REC | MS_PRIVATE, None)
        system('mount', b'proc', b'/proc', b'proc', 0, None)
        system('mount', b'tmpfs', b'/dev/shm', b'tmpfs', 0, b'mode=700')
    except OSError as error:
        raise Unavailable('file systems of a namespace are not permitted here'
                          ' (%s): be root' % error) from error
    os.mkdir(FILES)


def enter_network(name, address):
    """Enter a new network with one interface; return the wire's other end."""
    try:
        system('unshare', NEWNET | NEWUTS)
        socket.sethostname(name)
        wire = os.open('/dev/net/tun', os.O_RDWR)
        fcntl.ioctl(wire, TUNSETIFF,
                    struct.pack('16sH22x', b'wire', IFF_TUN | IFF_NO_PI))
    except OSError as error:
        raise Unavailable('networks are not permitted here (%s): be root, or,'
                          ' as root, chmod 666 /dev/net/tun' % error) from error
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:
        for request, text in ((SIOCSIFADDR, address),
                              (SIOCSIFNETMASK, '255.255.255.0')):
            fcntl.ioctl(control, request,
                        struct.pack('16sHH4s8x', b'wire', socket.AF_INET, 0,
                                    socket.inet_aton(text)))
        for interface in (b'lo', b'wire'):
            fcntl.ioctl(control, SIOCSIFFLAGS,
                        struct.pack('16sH14x', interface, IFF_UP))
    os.set_blocking(wire, False)
    return wire


# ----------------------------------------------------------------------- ssh

def write(name, text, mode=0o600):
    path = os.path.join(FILES, name)
    with open(path, 'w', encoding='utf8') as file:
        file.write(text)
    os.chmod(path, mode)
    return path


def make_keys():
    """Keys, and programs that use them; return the path of the latter."""
    ssh = shutil.which('ssh')
    if not ssh or not shutil.which('ssh-keygen'):
        raise Unavailable('ssh is missing: install openssh-client')
    for name in ('host', 'user'):
        subprocess.run(['ssh-keygen', '-q', '-t', 'ed25519', '-N', '', '-f',
                        os.path.join(FILES, name)], check=True)
    write('config', '\n'.join((
        'Port %d' % PORT, 'IdentityFile %s/user' % FILES, 'IdentitiesOnly yes',
        'BatchMode yes', 'LogLevel ERROR', 'StrictHostKeyChecking no',
        'UserKnownHostsFile /dev/null', '')))
    os.mkdir(FILES + '/bin')
    write('bin/ssh', '#!/bin/sh\nexec %s -F %s/config "$@"\n' % (ssh, FILES),
          0o700)
    return '%s/bin:%s' % (FILES, os.environ.get('PATH', os.defpath))


def start_daemon(address, path):
    """An ssh daemon in the network of this process."""
    program = shutil.which('sshd', path=path + ':/usr/sbin:/sbin')
    if not program:
        raise Unavailable('sshd is missing: install openssh-server')
    if os.geteuid() == 0:
        os.makedirs('/run/sshd', mode=0o755, exist_ok=True)
    config = write('sshd_' + address, '\n'.join((
        'Port %d' % PORT, 'ListenAddress ' + address,
        'HostKey %s/host' % FILES, 'AuthorizedKeysFile %s/user.pub' % FILES,
        'StrictModes no', 'UsePAM no', 'PidFile none', 'UseDNS no',
        'PermitRootLogin prohibit-password', 'MaxStartups 100',
        'SetEnv "PATH=%s"' % path, '')))
    def daemon():
        log = os.open(FILES + '/log', os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(log, 1)
        os.dup2(log, 2)
        os.execv(program, [program, '-D', '-e', '-f', config])

    spawn(daemon)


def spawn(program):
    """Call a function, which executes a program, in a child."""
    child = os.fork()
    if child:
        return child
    try:
        for signum in (signal.SIGINT, signal.SIGTERM, signal.SIGCHLD):
            signal.signal(signum, signal.SIG_DFL)
        program()
    except OSError as error:
        complain(error)
    finally:
        os._exit(127)


def wait_for_daemon(address):
    """Return when it answers, over the wires that delay and drop."""
    end = time.monotonic() + 30
    while True:
        try:
            with socket.create_connection((address, PORT), timeout=5) as link:
                if link.recv(4) == b'SSH-':
                    return
        except OSError:
            if time.monotonic() > end:
                raise
        time.sleep(0.02)


# --------------------------------------------------------------------- wires

def carry(machines, command):
    """Carry packets until the command ends; return its exit status."""
    woken, wake = os.pipe()
    for end in (woken, wake):
        os.set_blocking(end, False)
    signal.set_wakeup_fd(wake)
    by_address = {socket.inet_aton(m.address): m for m in machines}
    by_wire = {m.wire: m for m in machines}
    waiting, count = [], itertools.count()
    while True:
        status = ended(command)
        if status is not None:
            return status
        rest = max(0, waiting[0][0] - time.monotonic()) if waiting else None
        ready, _, _ = select.select([woken, *by_wire], [], [], rest)
        for wire in ready:
            for packet in packets(wire, 1500):
                target = by_address.get(packet[16:20])  # of an IPv4 header
                if wire != woken and target and arrives(by_wire[wire], target):
                    due = time.monotonic() + by_wire[wire].delay + target.delay
                    heapq.heappush(waiting,
                                   (due, next(count), target.wire, packet))
        while waiting and waiting[0][0] <= time.monotonic():
            _, _, wire, packet = heapq.heappop(waiting)
            with contextlib.suppress(OSError):      # its queue is full
                os.write(wire, packet)


def packets(wire, size):
    """What can be read at once."""
    try:
        while True:
            yield os.read(wire, size)
    except BlockingIOError:
        return


def arrives(*ends):
    return all(random.random() >= end.loss for end in ends)


def ended(command):
    """The status of the command, if it has ended; collects all others."""
    while True:
        try:
            child, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return 1
        if child == 0:
            return None
        if child == command:
            return os.waitstatus_to_exitcode(status)


# ------------------------------------------------------------------ the lab

def first_process(options):
    """Be the first process of the namespaces."""
    for signum in (signal.SIGINT, signal.SIGTERM):
        signal.signal(signum, lambda *_: os._exit(128 + signal.SIGTERM))
    mount_own()
    path = make_keys()
    machines = []
    for number in range(1, options.count + 1):
        address = NET + str(number)
        wire = enter_network('machine%d' % number, address)
        machines.append(Machine(address, wire, nth(options.delay, number) / 1e3,
                                nth(options.loss, number) / 1e2))
        start_daemon(address, path)
    addresses = [machine.address for machine in machines]
    machines.append(Machine(HERE, enter_network('here', HERE), 0, 0))

    def given():
        for address in addresses:
            wait_for_daemon(address)
        os.environ.update(PATH=path, TYPHON_BIND=HERE,
                          TYPHON_MACHINES=','.join(addresses))
        os.execvp(options.command[0], options.command)

    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.signal(signal.SIGINT, signal.SIG_IGN)    # the command's own affair
    command = spawn(given)
    signal.signal(signal.SIGTERM, lambda *_: os.kill(command, signal.SIGTERM))
    return carry(machines, command)


def nth(values, number):
    return values[(number - 1) % len(values)]


def numbers(text):
    return [float(part) for part in text.split(',')]


def arguments():
    parser = argparse.ArgumentParser(
        description='Run a command beside machines of its own: 10.213.78.1, '
                    '10.213.78.2 and so on, which it reaches by ssh. Its own '
                    'address is 10.213.78.254.')
    parser.add_argument('count', type=int, help='number of machines, 1 to 253')
    parser.add_argument('--delay', type=numbers, default=[0], metavar='MS,...',
                        help='of each packet at the first, second, ... machine,'
                             ' both ways; they are repeated if too few')
    parser.add_argument('--loss', type=numbers, default=[0], metavar='%,...',
                        help='of each packet there, likewise')
    parser.add_argument('command', nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if not options.command or not 1 <= options.count <= 253:
        parser.error('1 to 253 machines, and a command')
    if not shutil.which(options.command[0]):
        parser.error('%s: not found' % options.command[0])
    return options


def main():
    options = arguments()
    die_with(os.getppid())
    try:
        enter_namespaces()
    except Unavailable as error:
        return complain(error)
    me = os.getpid()
    first = os.fork()
    if first == 0:
        try:
            system('prctl', PR_SET_PDEATHSIG, signal.SIGKILL)
            status = first_process(options)
        except (Unavailable, OSError, subprocess.SubprocessError) as error:
            status = complain(error)
        os._exit(status if status >= 0 else 128 - status)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda *_: os.kill(first, signal.SIGTERM))
    return os.waitstatus_to_exitcode(os.waitpid(first, 0)[1])


def complain(error):
    print('machines: %s' % error, file=sys.stderr)
    return UNAVAILABLE


if __name__ == '__main__':
    sys.exit(main())
