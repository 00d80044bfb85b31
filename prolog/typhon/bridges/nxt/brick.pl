:- module(typhon_nxt_brick,
          [ nxt_connect/2,              % +Brick, +Port
            nxt_connect/3,              % +Brick, +Port, +Options
            nxt_disconnect/1,           % +Brick
            nxt_brick/2,                % ?Brick, ?Port
            nxt_command/4,              % +Brick, +Command, +Args, -Values
            nxt_battery/2,              % +Brick, -MilliVolts
            nxt_info/2,                 % +Brick, -Info
            nxt_set_name/2,             % +Brick, +Name
            nxt_keep_alive/2,           % +Brick, -Seconds
            nxt_tone/3,                 % +Brick, +Hertz, +MilliSeconds
            nxt_sound_file/3,           % +Brick, +File, +Loop
            nxt_sound_stop/1,           % +Brick
            nxt_write/4,                % +Brick, +Column, +Row, +Text
            nxt_clear/1,                % +Brick
            nxt_message_write/3,        % +Brick, +Inbox, +Text
            nxt_message_read/4          % +Brick, +Inbox, +Remove, -Text
          ]).
:- autoload(library(crypto), [hex_bytes/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module(link,
              [ link_brick/2, link_close/1, link_open/3, link_option/2,
                link_request/4, link_request/5, nxt_text/2 ]).

/** <module> A brick: connection, battery, name, sounds, display, mailboxes

*Threading*: any thread; see typhon_nxt_link.
*/

:- multifile typhon_options:declared/4.

%!  nxt_connect(+Brick, +Port) is det.
%!  nxt_connect(+Brick, +Port, +Options) is det.
%
%   Connect to the NXT at Port and name it Brick, an atom.  Port is a device
%   such as '/dev/rfcomm0', or a URL of pyserial such as
%   'socket://localhost:5000'. The brick has answered when this succeeds.
%   Options:
%
%     - deadline(Seconds): of every later call; default 3
%     - connect_deadline(Seconds): of this call; default 15
%     - confirm(Boolean): whether the brick must acknowledge commands that have
%       no other answer, such as motor commands; default `true`.  With `false`,
%       these are faster (a Bluetooth link needs a tenth of a second to change
%       direction), and succeed even if the brick is silent or refuses
%     - baudrate(N): default 115200
%     - python(Program): the Python of the helper; default see the setting
%       typhon_nxt_link:python
%
%   @error permission_error(connect, nxt_brick, Brick) if Brick is connected
%   @error See nxt_failure/5

nxt_connect(Brick, Port) :-
    nxt_connect(Brick, Port, []).

nxt_connect(Brick, Port, Options) :-
    must_be(atom, Brick),
    must_be(atom, Port),
    check_options(nxt_option, Options),
    link_open(Brick, Port, Options),
    option(connect_deadline(Seconds), Options, 15),
    catch(link_request(Brick, open, _{do:open}, Seconds, _), Ball,
          ( ignore(catch(link_close(Brick),
                         error(existence_error(_, _), _), true)),
            throw(Ball) )).

typhon_options:declared(nxt_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(deadline(X), between(0.01, 3600), X).
option_type(connect_deadline(X), between(0.01, 3600), X).
option_type(confirm(X), boolean, X).
option_type(baudrate(X), positive_integer, X).
option_type(python(X), atom, X).

%!  nxt_disconnect(+Brick) is det.
%
%   Close the connection.  The motors keep running.
%
%   @error existence_error(nxt_brick, Brick)

nxt_disconnect(Brick) :-
    must_be(atom, Brick),
    link_close(Brick).

%!  nxt_brick(?Brick, ?Port) is nondet.
%
%   Brick is connected at Port.

nxt_brick(Brick, Port) :-
    link_brick(Brick, Port).

%!  nxt_command(+Brick, +Command, +Args, -Values) is det.
%
%   Send any telegram.  Command is its name in LEGO's document, such as
%   'GETBATTERYLEVEL'; Args and Values are dicts; bridges/nxt/telegram.py has
%   the table of their fields.  Data are atoms of hexadecimal digits.
%
%   @error See nxt_failure/5

nxt_command(Brick, Command, Args, Values) :-
    must_be(atom, Brick),
    must_be(atom, Command),
    must_be(dict, Args),
    Request = _{do:telegram, command:Command, args:Args},
    (   unacknowledged(Command),
        link_option(Brick, confirm(false))
    ->  link_request(Brick, Command, Request.put(reply, false), Values)
    ;   link_request(Brick, Command, Request.put(reply, true), Values)
    ).

unacknowledged('SETOUTPUTSTATE').
unacknowledged('PLAYTONE').
unacknowledged('PLAYSOUNDFILE').

%!  nxt_battery(+Brick, -MilliVolts:integer) is det.
%
%   MilliVolts is the voltage of the battery.

nxt_battery(Brick, MilliVolts) :-
    nxt_command(Brick, 'GETBATTERYLEVEL', _{}, Values),
    MilliVolts = Values.millivolts.

%!  nxt_info(+Brick, -Info:list) is det.
%
%   Info has name(Atom), address(Atom), signal(Integer), the strength of the
%   Bluetooth signal, free_flash(Bytes), firmware(Major, Minor) and
%   protocol(Major, Minor).

nxt_info(Brick, Info) :-
    nxt_command(Brick, 'GETDEVICEINFO', _{}, Device),
    nxt_command(Brick, 'GETFIRMWAREVERSION', _{}, Version),
    colons(Device.address, Address),
    sub_atom(Device.signal, 0, 2, _, Hex),
    atom_concat('0x', Hex, Number),
    atom_number(Number, Signal),
    Info = [ name(Device.name), address(Address), signal(Signal),
             free_flash(Device.free_flash),
             firmware(Version.firmware_major, Version.firmware_minor),
             protocol(Version.protocol_major, Version.protocol_minor)
           ].

%   colons(+Hex, -Address): 001653010203 becomes 00:16:53:01:02:03.

colons(Hex, Address) :-
    findall(Byte,
            ( member(At, [0,2,4,6,8,10]), sub_atom(Hex, At, 2, _, Byte) ),
            Bytes),
    atomic_list_concat(Bytes, :, Lower),
    upcase_atom(Lower, Address).

%!  nxt_set_name(+Brick, +Name:atom) is det.
%
%   Give the brick another name, of at most 15 ASCII characters, which it keeps
%   and displays.  In this process it is still called Brick.

nxt_set_name(Brick, Name) :-
    nxt_text(15, Name),
    nxt_command(Brick, 'SETBRICKNAME', _{name:Name}, _).

%!  nxt_keep_alive(+Brick, -Seconds:number) is det.
%
%   Keep the brick from switching off.  It will switch off after Seconds without
%   a command; 0 means never.

nxt_keep_alive(Brick, Seconds) :-
    nxt_command(Brick, 'KEEPALIVE', _{}, Values),
    Seconds is Values.sleep_time/1000.

%!  nxt_tone(+Brick, +Hertz, +MilliSeconds) is det.
%
%   Begin a tone of 200 to 14000 Hz.

nxt_tone(Brick, Hertz, MilliSeconds) :-
    must_be(between(200, 14000), Hertz),
    must_be(between(0, 65535), MilliSeconds),
    nxt_command(Brick, 'PLAYTONE',
                _{frequency:Hertz, duration:MilliSeconds}, _).

%!  nxt_sound_file(+Brick, +File:atom, +Loop:boolean) is det.
%
%   Begin to play a .rso file of the brick.

nxt_sound_file(Brick, File, Loop) :-
    nxt_text(19, File),
    must_be(boolean, Loop),
    nxt_command(Brick, 'PLAYSOUNDFILE', _{loop:Loop, name:File}, _).

%!  nxt_sound_stop(+Brick) is det.
%
%   Stop any sound of Brick.

nxt_sound_stop(Brick) :-
    nxt_command(Brick, 'STOPSOUNDPLAYBACK', _{}, _).

%!  nxt_write(+Brick, +Column, +Row, +Text) is det.
%
%   Write on the display, which has rows 0 to 7 of columns 0 to 15.  Text beyond
%   the end of the row is cut off.  The firmware has no command for this: the
%   pixels are written into the memory of its display module, and its menus may
%   overwrite them.

nxt_write(Brick, Column, Row, Text0) :-
    must_be(between(0, 15), Column),
    must_be(between(0, 7), Row),
    format(atom(Text1), '~w', [Text0]),
    sub_atom(Text1, 0, Length, After, Text),
    ( After =:= 0 -> Length =< 16 ; Length =:= 16 ),
    !,
    link_request(Brick, display,
                 _{do:display, column:Column, row:Row, text:Text}, _).

%!  nxt_clear(+Brick) is det.
%
%   Clear the display.

nxt_clear(Brick) :-
    must_be(atom, Brick),
    link_request(Brick, clear, _{do:clear}, 10, _). % 16 telegrams

%!  nxt_message_write(+Brick, +Inbox, +Text) is det.
%
%   Send up to 58 bytes to box 0 to 9 of the program that is running.
%
%   @error nxt_error(refused(no_active_program), Brick)

nxt_message_write(Brick, Inbox, Text) :-
    must_be(between(0, 19), Inbox),
    format(codes(Codes), '~w', [Text]),
    hex_bytes(Hex, Codes),
    nxt_command(Brick, 'MESSAGEWRITE', _{inbox:Inbox, message:Hex}, _).

%!  nxt_message_read(+Brick, +Inbox, +Remove:boolean, -Text:atom) is semidet.
%
%   Read from a box of the running program; programs write messages for this
%   process into 10 to 19.  Fails if the box is empty.

nxt_message_read(Brick, Inbox, Remove, Text) :-
    must_be(between(0, 19), Inbox),
    must_be(boolean, Remove),
    Local is Inbox mod 10,
    catch(nxt_command(Brick, 'MESSAGEREAD',
                      _{remote:Inbox, local:Local, remove:Remove}, Values),
          error(nxt_error(refused(mailbox_empty), _), _),
          fail),
    hex_bytes(Values.message, Codes),
    atom_codes(Text, Codes).
