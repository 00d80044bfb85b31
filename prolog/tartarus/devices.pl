:- module(tartarus_devices,
          [ tts/1, tts_on/0, tts_off/0, subt_on/0, subt_off/0,
            python_call/3, python_call/4,
            mpu6050/2,
            create_billboard/5, write2billboard/4, create_dlg/3,
            attach_console/0
          ]).
:- use_module('../typhon', [python_start/3, remote/2]).
:- reexport('../typhon/bridges/nxt/swi_pro_nxt').
:- use_module(platform, [print_lines/2]).

/** <module> Speech, Python, robots

The predicates whose names end in `_nxt` drive robots; library(typhon/nxt)
defines them.  This library does not support I2C of a Raspberry Pi and windows
of XPCE: their predicates raise errors that name a replacement.

*Threading*: any thread.
*/

                /*******************************
                *            SPEECH            *
                *******************************/

:- dynamic
    speech/1,
    subtitles/1.

speech(on).
subtitles(off).

%!  tts(+Text) is det.
%!  tts_on is det.
%!  tts_off is det.
%!  subt_on is det.
%!  subt_off is det.
%
%   Speak Text if espeak-ng or espeak is installed and speech is on, and print
%   it if subtitles are on.

tts(Text) :-
    (   subtitles(on)
    ->  print_lines("~w~n", [Text])
    ;   true
    ),
    (   speech(on)
    ->  format(string(Words), '~w', [Text]),
        in_python(python_say(Words, _))
    ;   true
    ).

tts_on :- switch(speech(on)).
tts_off :- switch(speech(off)).
subt_on :- switch(subtitles(on)).
subt_off :- switch(subtitles(off)).

switch(Fact) :-
    functor(Fact, Name, 1),
    functor(Old, Name, 1),
    retractall(Old),
    assertz(Fact).

%!  python_call(+File, +Function, +Argument, -Result:atom) is semidet.
%!  python_call(+File, +Function, -Result:atom) is semidet.
%
%   Call a function of the Python module File with Argument as text without
%   quotes.  Result is the last line of its result.
%
%   @error process_error(Class, exit(1)): Python has raised an exception
%   @error existence_error(host, tartarus_gate) without a platform

python_call(File, Function, Argument, Result) :-
    format(string(Quoted), '~q', [Argument]),
    split_string(Quoted, "'", "", Parts),
    atomic_list_concat(Parts, Text),
    python(File, Function, [Text], Result).

python_call(File, Function, Result) :-
    python(File, Function, [], Result).

python(File, Function, Arguments, Result) :-
    working_directory(Folder, Folder),
    catch(in_python(python_result(Folder, File, Function, Arguments, Line)),
          error(python_error(Class, Message), _),
          throw(error(process_error(Class, exit(1)), context(_, Message)))),
    atom_string(Result, Line).

%   The functions of bridges/tartarus/tartarus.py run on the host
%   `tartarus_gate`, which programs do not use.

in_python(Goal) :-
    bridge(File),
    catch(python_start(tartarus_gate, File, [timeout(3600)]),
          error(permission_error(start, python, _), _),
          true),                        % it has been started before
    remote(tartarus_gate, Goal).

:- dynamic bridge/1.

:- module_property(tartarus_devices, file(Source)),
   file_directory_name(Source, Dir),
   absolute_file_name('../../bridges/tartarus/tartarus.py', File,
                      [relative_to(Dir)]),
   retractall(bridge(_)),
   assertz(bridge(File)).

%!  mpu6050(+Kind, -Result).
%!  create_billboard(+Name, +X, +Y, +Width, +Height).
%!  write2billboard(+Name, +Text, +X, +Y).
%!  create_dlg(+Name, +Title, +Text).
%!  attach_console.
%
%   @error existence_error(tartarus_device, What)

mpu6050(_, _) :- missing('I2C').
create_billboard(_, _, _, _, _) :- missing(windows).
write2billboard(_, _, _, _) :- missing(windows).
create_dlg(_, _, _) :- missing(windows).
attach_console :- missing(consoles).

missing(What) :-
    throw(error(existence_error(tartarus_device, What), _)).

:- multifile prolog:error_message//1.

prolog:error_message(existence_error(tartarus_device, What)) -->
    { advice(What, Advice) },
    [ 'Tartarus cannot reach ~w from here: ~w'-[What, Advice] ].

advice('I2C', 'read the sensor by python_call/4, or give the platform such a \c
               predicate').
advice(windows, 'print with format/2, or look at the page of the network').
advice(consoles, 'handlers read the terminal of their platform').
