"""System commands: files, modules, name, versions.

As direct ones: each gives the status and what follows it in the reply.
Replies keep their length when a command is refused."""

from .flash import EOF, FULL, NO_LINEAR_SPACE, Refused
from .telegrams import pack, packed_name

OK, UNDEFINED, NO_MODULE, OUT_OF_BOUNDS = 0x00, 0x8A, 0x90, 0x91
MOST = 250                      # bytes of data in one reply

# name: id, size of its IO map
MODULES = {
    'Command.mod': (0x00010001, 32828), 'Output.mod': (0x00020001, 97),
    'Input.mod': (0x00030001, 336), 'Button.mod': (0x00040001, 36),
    'Comm.mod': (0x00050001, 1896), 'IOCtrl.mod': (0x00060001, 2),
    'Sound.mod': (0x00080001, 30), 'Loader.mod': (0x00090001, 8),
    'Display.mod': (0x000A0001, 1720), 'Low Speed.mod': (0x000B0001, 167),
    'Ui.mod': (0x000C0001, 40),
}
MODULE_IDS = {number: size for number, size in MODULES.values()}


def keeps_length(size):
    """For commands whose reply has `size` more bytes, also if refused."""
    def wrap(command):
        def guarded(brick, request):
            try:
                return OK, command(brick, request)
            except Refused as refused:
                return refused.status, bytes(size)
        return guarded
    return wrap


@keeps_length(5)
def open_read(brick, request):
    return pack('BI', *brick.flash.open_read(request.name()))


def open_writer(data=False, linear=False):
    @keeps_length(1)
    def open_write(brick, request):
        name, size = request.name(), request.take('I')
        full = NO_LINEAR_SPACE if linear else 0x82
        return pack('B', brick.flash.open_write(name, size, data, full))
    return open_write


@keeps_length(5)
def open_append(brick, request):
    return pack('BI', *brick.flash.open_append(request.name()))


def read(brick, request):
    number, count = request.take('BH')
    if count > MOST:
        return OUT_OF_BOUNDS, pack('BH', number, 0)
    try:
        data, whole = brick.flash.read(number, count)
    except Refused as refused:
        return refused.status, pack('BH', number, 0)
    return (OK if whole else EOF), pack('BH', number, count) + data


def write(brick, request):
    number = request.take('B')
    try:
        written, whole = brick.flash.write(number, request.rest())
    except Refused as refused:
        return refused.status, pack('BH', number, 0)
    return (OK if whole else FULL), pack('BH', number, written)


def close(brick, request):
    number = request.take('B')
    try:
        brick.flash.close(number)
    except Refused as refused:
        return refused.status, pack('B', number)
    return OK, pack('B', number)


def delete(brick, request):
    name = request.name()
    try:
        brick.flash.delete(name)
    except Refused as refused:
        return refused.status, packed_name(name)
    return OK, packed_name(name)


def file_entry(brick, number, name):
    size = brick.flash.files[name].size()
    return pack('B', number) + packed_name(name) + pack('I', size)


@keeps_length(25)
def find_first(brick, request):
    return file_entry(brick, *brick.flash.find_first(request.name()))


def find_next(brick, request):
    number = request.take('B')
    try:
        name = brick.flash.find_next(number)
    except Refused as refused:
        return refused.status, pack('B', number) + bytes(24)
    return OK, file_entry(brick, number, name)


def module_entry(number, name):
    identity, size = MODULES[name]
    return (pack('B', number) + packed_name(name)
            + pack('IIH', identity, 0, size))


@keeps_length(31)
def first_module(brick, request):
    return module_entry(*brick.flash.find_first_module(request.name()))


def next_module(brick, request):
    number = request.take('B')
    try:
        name = brick.flash.find_next(number, 'module')
    except Refused as refused:
        return refused.status, pack('B', number) + bytes(30)
    return OK, module_entry(number, name)


def io_map(brick, identity, offset, count):
    """The map and what is wrong with the place asked for."""
    if identity not in MODULE_IDS:
        return None, NO_MODULE
    size = MODULE_IDS[identity]
    if offset + count > size or count > MOST:
        return None, OUT_OF_BOUNDS
    return brick.io_maps.setdefault(identity, bytearray(size)), OK


def read_io_map(brick, request):
    identity, offset, count = request.take('IHH')
    found, status = io_map(brick, identity, offset, count)
    if found is None:
        return status, pack('IH', identity, 0)
    data = bytes(found[offset:offset + count])
    return status, pack('IH', identity, count) + data


def write_io_map(brick, request):
    identity, offset, count = request.take('IHH')
    data = request.rest()[:count]
    found, status = io_map(brick, identity, offset, len(data))
    if found is None:
        return status, pack('IH', identity, 0)
    found[offset:offset + len(data)] = data
    return OK, pack('IH', identity, len(data))


def get_versions(brick, request):
    return OK, bytes([124, 1, 29, 1])   # protocol 1.124, firmware 1.29


def boot(brick, request):
    return UNDEFINED, bytes(4)          # not over Bluetooth


def set_brick_name(brick, request):
    brick.name = request.name(16)[:15]
    return OK, b''


def get_address(brick, request):
    return OK, brick.address + b'\0'


def get_device_info(brick, request):
    name = brick.name.encode('latin-1')[:14].ljust(15, b'\0')
    return OK, (name + brick.address + b'\0' + bytes(4)
                + pack('I', max(0, brick.flash.free())))


def delete_user_flash(brick, request):
    brick.flash.erase()
    return OK, b''


def poll_length(brick, request):
    buffer = request.take('B')
    return OK, pack('BB', buffer, 0)    # unused here


def poll(brick, request):
    buffer, count = request.take('BB')
    return OK, pack('BB', buffer, 0) + bytes(count)


def factory_reset(brick, request):
    return OK, b''


COMMANDS = {
    0x80: open_read, 0x81: open_writer(), 0x82: read, 0x83: write,
    0x84: close, 0x85: delete, 0x86: find_first, 0x87: find_next,
    0x88: get_versions, 0x89: open_writer(linear=True),
    0x8B: open_writer(data=True), 0x8C: open_append,
    0x90: first_module, 0x91: next_module, 0x92: close,
    0x94: read_io_map, 0x95: write_io_map, 0x97: boot,
    0x98: set_brick_name, 0x9A: get_address, 0x9B: get_device_info,
    0xA0: delete_user_flash, 0xA1: poll_length, 0xA2: poll,
    0xA4: factory_reset,
}
