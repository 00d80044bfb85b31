"""Direct commands: motors, sensors, sounds, programs, messages.

Every command takes the brick and the rest of its request, and gives the
status and what follows it in the reply."""

from .telegrams import pack, packed_name

OK, NO_PROGRAM, BAD_VALUE, UNKNOWN = 0x00, 0xEC, 0xC0, 0xBE
EMPTY, BAD_MAILBOX = 0x40, 0xEE
LONGEST_MESSAGE, MAILBOXES, PER_MAILBOX = 59, 20, 5
SLEEP_TIME = 10 * 60 * 1000     # milliseconds


def start_program(brick, request):
    name = request.name()
    if name not in brick.flash.files:
        return BAD_VALUE, b''
    brick.start_program(name)
    return OK, b''


def stop_program(brick, request):
    if brick.program is None:
        return NO_PROGRAM, b''
    brick.stop_program()
    return OK, b''


def play_sound_file(brick, request):
    loop = request.take('B')
    name = request.name()
    if name not in brick.flash.files:
        return BAD_VALUE, b''
    brick.sound('file', name, int(bool(loop)))
    return OK, b''


def play_tone(brick, request):
    frequency, duration = request.take('HH')
    brick.sound('tone', frequency, duration)
    return OK, b''


def stop_sound(brick, request):
    brick.sound('silence', 0, 0)
    return OK, b''


def set_output_state(brick, request):
    port, power, mode, regulation, turn, run, limit = request.take('BbBBbBI')
    if port > 2 and port != 0xFF:
        return BAD_VALUE, b''
    for number in range(3) if port == 0xFF else [port]:
        brick.motors[number].command(max(-100, min(100, power)), mode,
                                     regulation, turn, run, limit)
    return OK, b''


def get_output_state(brick, request):
    port = request.take('B')
    if port > 2:
        return BAD_VALUE, bytes(22)
    m = brick.motors[port]
    return OK, pack('BbBBbBIiii', port, m.power, m.mode, m.regulation,
                    m.turn, m.run_state, m.limit, *m.counters())


def reset_motor_position(brick, request):
    port, relative = request.take('BB')
    if port > 2:
        return BAD_VALUE, b''
    brick.motors[port].reset(bool(relative))
    return OK, b''


def set_input_mode(brick, request):
    port, kind, mode = request.take('BBB')
    if port > 3:
        return BAD_VALUE, b''
    brick.inputs[port].setup(kind, mode, brick.time)
    return OK, b''


def get_input_values(brick, request):
    port = request.take('B')
    if port > 3:
        return BAD_VALUE, bytes(13)
    at = brick.inputs[port]
    valid, raw, level, scaled = at.values(brick.time)
    return OK, pack('BBBBBHHhH', port, valid, 0, at.type, at.mode,
                    raw, level, scaled, level)


def reset_input_scaled_value(brick, request):
    port = request.take('B')
    if port > 3:
        return BAD_VALUE, b''
    brick.inputs[port].reset_scaled()
    return OK, b''


def message_write(brick, request):
    inbox, size = request.take('BB')
    message = request.rest()[:size]
    if not 0 < size <= LONGEST_MESSAGE or message[size - 1:] != b'\0':
        return BAD_VALUE, b''
    if brick.program is None:
        return NO_PROGRAM, b''
    if inbox >= MAILBOXES:
        return BAD_MAILBOX, b''
    box = brick.mailboxes[inbox]
    box.append(message)
    del box[:-PER_MAILBOX]              # the oldest is lost
    return OK, b''


def message_read(brick, request):
    remote, local, remove = request.take('BBB')
    status, message = next_message(brick, remote, remove)
    data = message.ljust(LONGEST_MESSAGE, b'\0')
    return status, pack('BB', local, len(message)) + data


def next_message(brick, number, remove):
    if brick.program is None:
        return NO_PROGRAM, b''
    if number >= MAILBOXES:
        return BAD_MAILBOX, b''
    box = brick.mailboxes[number]
    if not box:
        return EMPTY, b''
    return OK, box.pop(0) if remove else box[0]


def get_battery_level(brick, request):
    return OK, pack('H', brick.millivolts)


def keep_alive(brick, request):
    return OK, pack('I', SLEEP_TIME)


def ls_get_status(brick, request):
    port = request.take('B')
    if port > 3:
        return BAD_VALUE, b''
    status, ready = brick.inputs[port].lowspeed.status(brick.time)
    return status, pack('B', ready)


def ls_write(brick, request):
    port, size, count = request.take('BBB')
    data = request.rest()[:size]
    if port > 3:
        return BAD_VALUE, b''
    if size > 16:                       # of which not all need to have come
        return 0xED, b''
    return brick.inputs[port].lowspeed.write(data, count, brick.time), b''


def ls_read(brick, request):
    port = request.take('B')
    if port > 3:
        return BAD_VALUE, b''
    status, data = brick.inputs[port].lowspeed.read(brick.time)
    return status, pack('B', len(data)) + data.ljust(16, b'\0')


def get_current_program_name(brick, request):
    if brick.program is None:
        return NO_PROGRAM, bytes(20)
    return OK, packed_name(brick.program)


COMMANDS = {
    0x00: start_program, 0x01: stop_program, 0x02: play_sound_file,
    0x03: play_tone, 0x04: set_output_state, 0x05: set_input_mode,
    0x06: get_output_state, 0x07: get_input_values,
    0x08: reset_input_scaled_value, 0x09: message_write,
    0x0A: reset_motor_position, 0x0B: get_battery_level,
    0x0C: stop_sound, 0x0D: keep_alive, 0x0E: ls_get_status,
    0x0F: ls_write, 0x10: ls_read, 0x11: get_current_program_name,
    0x13: message_read,
}
