:- module(tartarus_devices,
          [ tts/1, tts_on/0, tts_off/0, subt_on/0, subt_off/0,
            python_call/3, python_call/4,
            pinMode/2, digitalWrite/2, digitalRead/2, pwmWrite/2,
            ledOn/2, ledOff/2, servo/4, mpu6050/2,
            create_billboard/5, write2billboard/4, create_dlg/3,
            attach_console/0
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [append/3, last/2, member/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- reexport(library(typhon/nxt/swi_pro_nxt)).
:- use_module(told, [told/2]).

/** <module> Speech, Python, robots, pins

Robots are driven by library(typhon/nxt), which has the names that end in
`_nxt`.  Pins of a Raspberry Pi and windows of XPCE are not reached from here:
these predicates say what to use instead.

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
%   Say Text, where espeak-ng or espeak is installed and speech is on, and
%   print it if subtitles are on.

tts(Text) :-
    (   subtitles(on)
    ->  told("~w~n", [Text])
    ;   true
    ),
    (   speech(on),
        speaker(Program)
    ->  format(string(Words), '~w', [Text]),
        run(Program, [Words], _)
    ;   true
    ).

speaker(Program) :-
    member(Name, ['espeak-ng', espeak]),
    absolute_file_name(path(Name), Program,
                       [access(execute), file_errors(fail)]),
    !.

tts_on :- switch(speech(on)).
tts_off :- switch(speech(off)).
subt_on :- switch(subtitles(on)).
subt_off :- switch(subtitles(off)).

switch(Fact) :-
    functor(Fact, Name, 1),
    functor(Old, Name, 1),
    retractall(Old),
    assertz(Fact).

                /*******************************
                *            PYTHON            *
                *******************************/

%!  python_call(+File, +Function, +Argument, -Result:atom) is semidet.
%!  python_call(+File, +Function, -Result:atom) is semidet.
%
%   Call a function of the Python module File in a process of its own, with
%   Argument as text without quotes.  Result is the last line printed.
%
%   @error process_error(Program, exit(Status)): what Python said is on the
%          standard error

python_call(File, Function, Argument, Result) :-
    format(string(Quoted), '~q', [Argument]),
    split_string(Quoted, "'", "", Parts),
    atomics_to_string(Parts, Text),
    python(File, Function, [Text], Result).

python_call(File, Function, Result) :-
    python(File, Function, [], Result).

atomics_to_string(Parts, Text) :-
    atomic_list_concat(Parts, Text).

%   The argument is none of the code: whatever is in it stays text.

python(File, Function, Arguments, Result) :-
    format(string(Code),
           'import sys; sys.path.insert(0, ""); import ~w as m; \c
            print(m.~w(*sys.argv[1:]))',
           [File, Function]),
    append(["-c",Code], Arguments, Argv),
    absolute_file_name(path(python3), Program, [access(execute)]),
    run(Program, Argv, Output),
    split_string(Output, "\n", "\r", Lines0),
    exclude(==(""), Lines0, Lines),
    last(Lines, Last),
    atom_string(Result, Last).

run(Program, Arguments, Output) :-
    setup_call_cleanup(
        process_create(Program, Arguments,
                       [stdout(pipe(Out)), process(Pid)]),
        read_string(Out, _, Output),
        close(Out)),
    process_wait(Pid, Status),
    (   Status == exit(0)
    ->  true
    ;   throw(error(process_error(Program, Status), _))
    ).

                /*******************************
                *        WHAT IS MISSING       *
                *******************************/

%!  pinMode(+Pin, +Mode).
%!  digitalWrite(+Pin, +Value).
%!  digitalRead(+Pin, -Value).
%!  pwmWrite(+Pin, +Value).
%!  ledOn(+Pin, -Result).
%!  ledOff(+Pin, -Result).
%!  servo(+Pin, +Frequency, +Duty, -Result).
%!  mpu6050(+Kind, -Result).
%!  create_billboard(+Name, +X, +Y, +Width, +Height).
%!  write2billboard(+Name, +Text, +X, +Y).
%!  create_dlg(+Name, +Title, +Text).
%!  attach_console.
%
%   @error existence_error(tartarus_device, What)

pinMode(_, _) :- missing(pins).
digitalWrite(_, _) :- missing(pins).
digitalRead(_, _) :- missing(pins).
pwmWrite(_, _) :- missing(pins).
ledOn(_, _) :- missing(pins).
ledOff(_, _) :- missing(pins).
servo(_, _, _, _) :- missing(pins).
mpu6050(_, _) :- missing(pins).
create_billboard(_, _, _, _, _) :- missing(windows).
write2billboard(_, _, _, _) :- missing(windows).
create_dlg(_, _, _) :- missing(windows).
attach_console :- missing(consoles).

missing(What) :-
    throw(error(existence_error(tartarus_device, What), _)).

:- multifile prolog:error_message//1.

prolog:error_message(existence_error(tartarus_device, What)) -->
    { advice(What, Advice) },
    [ 'Tartarus: ~w are not reached from here: ~w'-[What, Advice] ].

advice(pins, 'give the platform predicates of these names, as by \c
              host_change(tartarus, services(Module)), which drive them').
advice(windows, 'print with format/2, or look at the page of the network').
advice(consoles, 'handlers read the terminal of their platform').
