:- module(typhon_nxt_swi_pro_nxt,
          [ setup_nxt/1,
            initialize_nxt/4,
            connect2_nxt/4,
            connect_nxt/3,
            close_nxt/1,
            write_nxt/2,
            written_nxt/2,
            read_nxt/2,
            read_res_nxt/2,
            check_res_nxt/2,
            write_lcd_nxt/4,
            clear_lcd_nxt/1,
            beep_nxt/2,
            wait_nxt/2,
            exec_nxt/2,
            del_nxt/2,
            exists_nxt/3,
            download_nxt/3,
            get_files_nxt/2
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(brick).
:- use_module(files).
:- use_module(link, [link_set/3, link_unset/2, link_value/4]).

:- reexport(old_devices).

/** <module> The names of SWI-PRO-NXT

These are the predicates by which Tartarus controlled its robots, implemented
over this bridge and LEGO's own firmware; no program is needed on the brick.
Name is an atom chosen by the caller.  Wrong arguments raise type and domain
errors; for other errors see nxt_failure/5.

*Threading*: any thread; see typhon_nxt_link.
*/

%!  setup_nxt(+Name) is det.
%
%   Has no effect: this bridge needs no program on the brick.

setup_nxt(Name) :-
    must_be(atom, Name).

%!  initialize_nxt(+Name, +Link, +Port, -Response) is det.
%!  connect2_nxt(+Name, +Link, +Port, -Response) is det.
%!  connect_nxt(+Name, +Link, +Port) is det.
%
%   Connect to a brick and name it Name.  Link is a device or URL as of
%   nxt_connect/2, and then Port is ignored; or a host name, and then Port is
%   its TCP port.  Response is `started`.

initialize_nxt(Name, Link, Port, started) :-
    connect_nxt(Name, Link, Port).

connect2_nxt(Name, Link, Port, started) :-
    connect_nxt(Name, Link, Port).

connect_nxt(Name, Link, Port) :-
    must_be(atom, Link),
    (   sub_atom(Link, _, _, _, /)
    ->  Address = Link
    ;   must_be(between(1, 65535), Port),
        format(atom(Address), 'socket://~w:~d', [Link, Port])
    ),
    nxt_connect(Name, Address).

%!  close_nxt(+Name) is det.
%
%   Disconnect, and delete the values stored for Name.

close_nxt(Name) :-
    nxt_disconnect(Name),
    link_unset(Name, _).

%!  write_nxt(+Name, +Msg) is det.
%!  written_nxt(+Name, +Msg) is det.
%
%   Send a telegram: Msg is a command of LEGO's document, or Command-Args with
%   the dict of its fields, see nxt_command/4.  The reply to write_nxt/2 is kept
%   for read_res_nxt/2.

write_nxt(Name, Msg) :-
    send(Name, Msg, Values),
    link_set(Name, reply, Values).

written_nxt(Name, Msg) :-
    send(Name, Msg, _).

send(Name, Msg, Values) :-
    (   Msg = Command-Args
    ->  true
    ;   Command = Msg,
        Args = _{}
    ),
    nxt_command(Name, Command, Args, Values).

%!  read_res_nxt(+Name, -Values) is det.
%!  read_nxt(+Name, -Values) is semidet.
%!  check_res_nxt(+Name, -Values) is semidet.
%
%   Values is the dict of the reply to the last write_nxt/2.  read_nxt/2 fails
%   if there is none; check_res_nxt/2 prints it.
%
%   @error existence_error(nxt_reply, Name)

read_res_nxt(Name, Values) :-
    (   read_nxt(Name, Values0)
    ->  Values = Values0
    ;   existence_error(nxt_reply, Name)
    ).

read_nxt(Name, Values) :-
    link_value(Name, reply, none, Values0),
    Values0 \== none,
    link_unset(Name, reply),
    Values = Values0.

check_res_nxt(Name, Values) :-
    read_nxt(Name, Values),
    print(Values),
    nl.

                /*******************************
                *      DISPLAY AND SOUNDS      *
                *******************************/

%!  write_lcd_nxt(+Name, +X, +Y, +Atom) is det.
%!  clear_lcd_nxt(+Name) is det.
%
%   Write Atom on the display, from column X, 0 to 15, in row Y, 0 to 7; clear
%   the display.

write_lcd_nxt(Name, X, Y, Atom) :-
    must_be(atomic, Atom),
    nxt_write(Name, X, Y, Atom).

clear_lcd_nxt(Name) :-
    nxt_clear(Name).

%!  beep_nxt(+Name, +Type) is det.
%
%   Play a sound: Type is 1 for a beep, 2 for two beeps, 3 for a rising
%   sequence, 4 for a buzz.

beep_nxt(Name, Type) :-
    must_be(integer, Type),
    (   beep(Type, Tones)
    ->  maplist(beep_tone(Name), Tones)
    ;   domain_error(beep_nxt, Type)
    ).

beep(1, [600-200]).
beep(2, [600-150, 600-150]).
beep(3, [523-100, 659-100, 784-100, 1047-150]).
beep(4, [220-500]).

%   A new tone ends the previous one, so wait for its end.

beep_tone(Name, Hertz-MilliSeconds) :-
    nxt_tone(Name, Hertz, MilliSeconds),
    Seconds is MilliSeconds/1000+0.05,
    sleep(Seconds).

%!  wait_nxt(+Name, +Time) is det.
%
%   Wait for Time milliseconds.  The robot continues what it does.

wait_nxt(Name, Time) :-
    must_be(atom, Name),
    must_be(nonneg, Time),
    Seconds is Time/1000,
    sleep(Seconds).

                /*******************************
                *            FILES             *
                *******************************/

%!  exec_nxt(+Name, +Program) is det.
%
%   Start a program; `.rxe` may be left out.

exec_nxt(Name, Program) :-
    must_be(atom, Program),
    (   file_name_extension(_, '', Program)
    ->  file_name_extension(Program, rxe, File)
    ;   File = Program
    ),
    nxt_program_start(Name, File).

%!  del_nxt(+Name, +File) is det.
%
%   Delete a file of the brick.

del_nxt(Name, File) :-
    nxt_file_delete(Name, File).

%!  exists_nxt(+Name, +File, -R) is det.
%
%   R is the atom '1' or '0'.

exists_nxt(Name, File, R) :-
    ( nxt_file_exists(Name, File) -> R = '1' ; R = '0' ).

%!  download_nxt(+Name, +File, +Path) is det.
%
%   Copy File of the directory Path to the brick, unchanged.

download_nxt(Name, File, Path) :-
    must_be(atom, File),
    must_be(atom, Path),
    directory_file_path(Path, File, Local),
    nxt_upload(Name, Local, File).

%!  get_files_nxt(+Name, -Files) is det.
%
%   Files is an atom of all names, separated by blanks; it is also printed.

get_files_nxt(Name, Files) :-
    nxt_files(Name, '*.*', Pairs),
    pairs_keys(Pairs, Names),
    atomic_list_concat(Names, ' ', Files),
    writeln(Files).
