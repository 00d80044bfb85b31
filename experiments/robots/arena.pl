:- module(robots_arena,
          [ arena_start/4,              % +Scene, +Options, -Arena, -Bricks
            arena_ask/3,                % +Arena, +Line, -Answer
            arena_stop/1,               % +Arena
            scene_file/2                % +Scene, -File
          ]).
:- use_module('../../prolog/typhon/kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../prolog/typhon/kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../prolog/typhon/kernel/base/private', [private_folder/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), 
              [delete_directory_and_contents/1, relative_file_name/3]).
:- use_module(library(lists), [append/2, append/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/3]).

/** <module> The arena: simulated robots in a process of their own

A child process, `bridges/nxt/world.py`, simulates robots, each with a brick at
the end of a serial line, and the objects that they carry or push.
Programs that drive a robot use only its serial line.

*Threading*: one thread asks an arena at a time.
*/

:- multifile
    prolog:error_message//1.

%!  scene_file(+Scene:atom, -File) is det.
%
%   File is the file of a scene that is part of the simulation.

scene_file(Scene, File) :-
    format(atom(Name), 'scenes/~w.json', [Scene]),
    nxt_file(Name, File).

nxt_file(Name, File) :-
    module_property(robots_arena, file(Here)),
    atom_concat('../../bridges/nxt/', Name, Relative),
    relative_file_name(File, Here, Relative).

%!  arena_start(+Scene, +Options, -Arena, -Bricks) is det.
%
%   Starts the arena that the JSON file Scene describes.  Bricks are pairs
%   Robot-Port, Port being the serial line of the robot's brick.  Options:
%
%     - clock(Rate): arena seconds in a second, default 1; with 0 time
%       passes only by the lines `advance SECONDS` and `until TIME`
%     - telegram(Seconds): arena seconds that each telegram takes in addition,
%       default 0: with clock(0), repeated reading lets a sensor settle
%     - seed(Integer): of the gains of the motors and the noise of sensors
%     - log(File), every(Seconds): a log of terms state(Time, Robots, Pole,
%       Boxes), one every Seconds arena seconds, and event(Time, What), with
%       Time in arena seconds
%     - picture(File): an animated picture of the run, written at the end
%
%   @error arena_error(start, Text)

arena_start(Scene, Options, Arena, Bricks) :-
    tmp_file(arena, Prefix),
    private_folder(Prefix, Dir),
    arguments(Scene, Dir, Options, Arguments),
    python(Python),
    process_create(Python, Arguments,
                   [ stdin(pipe(In)), stdout(pipe(Out)), process(Pid),
                     detached(true)     % signals reach only this process
                   ]),
    set_stream(Out, timeout(30)),
    Arena = arena(Pid, In, Out, Dir),
    catch(ready(Out, Bricks), Ball,
          ( arena_stop(Arena),
            throw(Ball) )).

%   Not the first Python of the path: only the Python of the system is sure to
%   have pyserial.

python('/usr/bin/python3') :-
    exists_file('/usr/bin/python3'),
    !.
python(path(python3)).

arguments(Scene, Dir, Options, Arguments) :-
    nxt_file('world.py', World),
    absolute_file_name(Scene, File, [access(read)]),
    findall([Flag, Value],
            ( flag(Option, Flag, Value), option(Option, Options) ),
            Pairs),
    append(Pairs, More),
    append(['-u', World, File, '--pty', Dir, '--until-eof'], More,
           Arguments).

flag(clock(Rate), '--clock', Rate).
flag(telegram(Seconds), '--telegram', Seconds).
flag(seed(Seed), '--seed', Seed).
flag(log(File), '--log', File).
flag(every(Seconds), '--every', Seconds).
flag(picture(File), '--picture', File).

ready(Out, Bricks) :-
    read(Out, Term),
    (   Term = ready(List)
    ->  maplist(brick, List, Bricks)
    ;   throw(error(arena_error(start, Term), _))
    ).

brick(brick(Robot, pty(Port), _), Robot-Port).

%!  arena_ask(+Arena, +Line, -Answer) is det.
%
%   Answer is the term by which the arena answers Line, an atom, or
%   Format-Arguments as for format/2.
%
%   @error arena_error(Line, Text), where Text is the message of the arena

arena_ask(arena(_, In, Out, _), Line0, Answer) :-
    (   Line0 = Format-Arguments
    ->  format(atom(Line), Format, Arguments)
    ;   Line = Line0
    ),
    catch(( format(In, '~w~n', [Line]),
            flush_output(In),
            read(Out, Term) ),
          error(io_error(_, _), _),
          Term = end_of_file),
    answer(Term, Line, Answer).

answer(error(Text), Line, _) :-
    !,
    throw(error(arena_error(Line, Text), _)).
answer(end_of_file, Line, _) :-
    !,
    throw(error(arena_error(Line, 'it has ended'), _)).
answer(Answer, _, Answer).

%!  arena_stop(+Arena) is det.
%
%   Ends the arena in order, and kills it if that takes too long.  Does nothing
%   if the arena has ended.

arena_stop(arena(Pid, In, Out, Dir)) :-
    in_own_thread(stop(Pid, In)),
    close(Out, [force(true)]),
    delete_directory_and_contents(Dir).

stop(Pid, In) :-
    catch(( format(In, 'quit~n', []), flush_output(In) ), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true),
    monotonic_time(Now),
    Deadline is Now + 20,       % the arena may write a long picture
    (   ended(Pid, Deadline)
    ->  true
    ;   process_kill(Pid, kill),
        process_wait(Pid, _, [])
    ).

ended(Pid, Deadline) :-
    process_wait(Pid, Status, [timeout(0)]),
    (   Status \== timeout
    ->  true
    ;   monotonic_time(Now),
        Now < Deadline,
        sleep(0.02),
        ended(Pid, Deadline)
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(arena_error(start, Term)) -->
    [ 'The arena did not start: ~p'-[Term] ].
prolog:error_message(arena_error(Line, Text)) -->
    [ 'The arena was told "~w": ~w'-[Line, Text] ].
