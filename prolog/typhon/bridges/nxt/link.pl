:- module(typhon_nxt_link,
          [ link_open/3,                % +Brick, +Port, +Options
            link_close/1,               % +Brick
            link_request/4,             % +Brick, +What, +Fields, -Reply
            link_request/5,             % +Brick, +What, +Fields, +Seconds,
                                        % -Reply
            link_option/2,              % +Brick, ?Option
            link_brick/2,               % ?Brick, ?Port
            link_set/3,                 % +Brick, +Key, +Value
            link_value/4,               % +Brick, +Key, +Default, -Value
            link_unset/2,               % +Brick, ?Key
            nxt_python/2,               % +Options, -Program
            nxt_text/2                  % +Length, +Text
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [ domain_error/2, existence_error/2, must_be/2,
                permission_error/3 ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../helper',
              [ helper_call/5, helper_close/1, helper_file/2, helper_open/3,
                helper_python/2 ]).

/** <module> Requests to bricks, and their answers

Every connected brick has a helper, which owns its serial line: `python3
bridges/nxt/bridge.py PORT`.  That file describes the lines that it reads and
writes.  The next request restarts a helper that has died.  A helper serves its
requests one after the other; different bricks have different helpers.

*Threading*: any thread may send requests; see typhon_helper_requests.
*/

:- dynamic
    brick/3.                    % Brick, Port, Options

%!  link_open(+Brick, +Port, +Options) is det.
%
%   Begin the helper of Brick at Port.
%
%   @error permission_error(connect, nxt_brick, Brick) if Brick is connected

link_open(Brick, Port, Options) :-
    nxt_command_line(Port, Options, Command),
    with_mutex(typhon_nxt, open_link(Brick, Port, Options, Command)).

open_link(Brick, _, _, _) :-
    brick(Brick, _, _),
    !,
    permission_error(connect, nxt_brick, Brick).
open_link(Brick, Port, Options, Command) :-
    sig_atomic(( helper_open(nxt(Brick), Command, []),
                 assertz(brick(Brick, Port, Options)) )).

%!  link_close(+Brick) is det.
%
%   End the helper.  Open requests get an error.
%
%   @error existence_error(nxt_brick, Brick)

link_close(Brick) :-
    (   retract(brick(Brick, _, _))
    ->  helper_close(nxt(Brick))
    ;   existence_error(nxt_brick, Brick)
    ).

%!  link_brick(?Brick, ?Port) is nondet.

link_brick(Brick, Port) :-
    brick(Brick, Port, _).

%!  link_option(+Brick, ?Option) is nondet.
%
%   Brick was connected with Option.
%
%   @error existence_error(nxt_brick, Brick)

link_option(Brick, Option) :-
    connected_brick(Brick, _, Options),
    member(Option, Options).

connected_brick(Brick, Port, Options) :-
    (   brick(Brick, Port, Options)
    ->  true
    ;   existence_error(nxt_brick, Brick)
    ).

%!  link_request(+Brick, +What, +Fields, -Reply) is det.
%!  link_request(+Brick, +What, +Fields, +Seconds, -Reply) is det.
%
%   The helper of Brick carries out What, a command of LEGO's document or a
%   function of the helper, with the dict Fields.  Reply is a dict.  Seconds is
%   the deadline, default that of the brick.
%
%   @error existence_error(nxt_brick, Brick)
%   @error See nxt_failure/5

link_request(Brick, What, Fields, Reply) :-
    connected_brick(Brick, _, Options),
    option(deadline(Seconds), Options, 3),
    link_request(Brick, What, Fields, Seconds, Reply).

link_request(Brick, What, Fields, Seconds, Reply) :-
    connected_brick(Brick, Port, _),
    catch(helper_call(nxt(Brick), Fields, Seconds,
                      nxt_failure(Brick, Port, What), Reply0),
          error(existence_error(helper, _), _),
          existence_error(nxt_brick, Brick)),
    atoms(Reply0, Reply).

%   In this protocol strings are names, so they become atoms.

atoms(Dict0, Dict) :-
    is_dict(Dict0),
    !,
    dict_pairs(Dict0, Tag, Pairs0),
    maplist(atoms_pair, Pairs0, Pairs),
    dict_pairs(Dict, Tag, Pairs).
atoms(Text, Atom) :-
    string(Text),
    !,
    atom_string(Atom, Text).
atoms(Value, Value).

atoms_pair(Key-Value0, Key-Value) :-
    atoms(Value0, Value).

                /*******************************
                *            HELPER            *
                *******************************/

:- setting(python, atom, '',
           "The Python of the helpers of bricks; '' for that of all helpers").

%!  nxt_python(+Options, -Program) is det.
%
%   As helper_python/2, but the setting for bricks, if set, is the default.

nxt_python(Options, Python) :-
    (   option(python(_), Options)
    ->  helper_python(Options, Python)
    ;   setting(python, Name),
        Name \== ''
    ->  helper_python([python(Name)], Python)
    ;   helper_python([], Python)
    ).

%   nxt_command_line(+Port, +Options, -Command) is det.
%
%   Command is for helper_open/3.  Options: python(Program), baudrate(N).

nxt_command_line(Port, Options,
                 command(Python,
                         ['-u', File, '--baudrate', Baud, '--', Port])) :-
    nxt_python(Options, Python),
    helper_file('nxt/bridge.py', File),
    option(baudrate(Baud), Options, 115200).

%!  nxt_text(+Length:integer, +Text) is det.
%
%   Text is an atom of 1 to Length ASCII characters.
%
%   @error domain_error(nxt_text(Length), Text) if Text is not an atom of 1
%          to Length ASCII characters

nxt_text(Length, Text) :-
    must_be(atom, Text),
    atom_codes(Text, Codes),
    length(Codes, Long),
    (   between(1, Length, Long),
        forall(member(Code, Codes), between(1, 127, Code))
    ->  true
    ;   domain_error(nxt_text(Length), Text)
    ).

                /*******************************
                *            ERRORS            *
                *******************************/

:- multifile
    prolog:error_message//1.

%   nxt_failure(+Brick, +Port, +What, +Answer, -Error) is det.
%
%   Error is that for an answer of the helper, or for a missing answer.  Its
%   context is context(nxt(Brick, What), Text), where Text is the message of the
%   helper.
%
%   @error existence_error(nxt_port, Port) if there is no such port
%   @error permission_error(open, nxt_port, Port)
%   @error permission_error(lock, nxt_port, Port) if another program has it
%   @error timeout_error(nxt(What), Brick) if the brick is silent
%   @error nxt_error(refused(Status), Brick), Status being the name of the
%          status byte
%   @error nxt_error(line_lost, Brick)
%   @error nxt_error(garbage, Brick) for an invalid answer
%   @error nxt_error(open_failed, Brick) for other reasons
%   @error nxt_error(helper_died(Status), Brick), Status as of
%          process_wait/2, or `stuck` if it had to be killed
%   @error existence_error(python_module, serial)
%   @error existence_error(python, Program)
%   @error existence_error(nxt_brick, Brick) if it was disconnected meanwhile
%   @error domain_error(nxt_request, What) if the helper rejects the request

nxt_failure(Brick, Port, What, Answer,
            error(Formal, context(nxt(Brick, What), Text))) :-
    failure(Answer, Brick, Port, What, Formal, Text).

failure(said(Dict0), Brick, Port, What, Formal, Text) :-
    atoms(Dict0, Dict),
    _{error:Kind, message:Text0} :< Dict,
    (   Kind == no_pyserial,
        get_dict(python, Dict, Python)
    ->  atomic_list_concat([Python, ': ', Text0], Text)
    ;   Text = Text0
    ),
    formal(Kind, Dict, Brick, Port, What, Formal).
failure(died(Status), Brick, _, _, nxt_error(helper_died(Status), Brick), _).
failure(stuck, Brick, _, _, nxt_error(helper_died(stuck), Brick), _).
failure(closed, Brick, _, _, existence_error(nxt_brick, Brick), _).
failure(error(Formal, Context), _, _, _, Formal, Text) :-
    ( Context = context(_, Text) -> true ; true ).

formal(no_such_port, _, _, Port, _, existence_error(nxt_port, Port)) :- !.
formal(permission, _, _, Port, _,
       permission_error(open, nxt_port, Port)) :- !.
formal(busy_port, _, _, Port, _,
       permission_error(lock, nxt_port, Port)) :- !.
formal(timeout, _, Brick, _, What, timeout_error(nxt(What), Brick)) :- !.
formal(refused, Dict, Brick, _, _, nxt_error(refused(Status), Brick)) :-
    !,
    get_dict(status, Dict, Status).
formal(no_pyserial, _, _, _, _,
       existence_error(python_module, serial)) :- !.
formal(bad_request, _, _, _, What, domain_error(nxt_request, What)) :- !.
formal(Kind, _, Brick, _, _, nxt_error(Kind, Brick)).

                /*******************************
                *            VALUES            *
                *******************************/

%   The predicates of SWI-PRO-NXT keep speeds, accelerations, lamps, offsets,
%   and replies not yet read.

:- dynamic
    value/3.                    % Brick, Key, Value

%!  link_set(+Brick, +Key, +Value) is det.
%!  link_value(+Brick, +Key, +Default, -Value) is det.
%!  link_unset(+Brick, ?Key) is det.
%
%   Store a value for Brick, which survives a lost connection; return it, or
%   Default; delete it.

link_set(Brick, Key, Value) :-
    with_mutex(typhon_nxt_values,
               ( retractall(value(Brick, Key, _)),
                 assertz(value(Brick, Key, Value)) )).

link_value(Brick, Key, Default, Value) :-
    (   value(Brick, Key, Value0)
    ->  Value = Value0
    ;   Value = Default
    ).

link_unset(Brick, Key) :-
    retractall(value(Brick, Key, _)).

prolog:error_message(existence_error(nxt_port, Port)) -->
    [ 'There is no port ~w'-[Port] ].
prolog:error_message(existence_error(nxt_brick, Brick)) -->
    [ 'No brick ~w is connected'-[Brick] ].
prolog:error_message(existence_error(python_module, serial)) -->
    [ 'This Python has no pyserial (install it: apt install \c
       python3-serial, or pip install pyserial)' ].
prolog:error_message(permission_error(open, nxt_port, Port)) -->
    [ 'You may not use ~w (is your user in the group dialout?)'-[Port] ].
prolog:error_message(permission_error(lock, nxt_port, Port)) -->
    [ 'Another program uses ~w'-[Port] ].
prolog:error_message(permission_error(connect, nxt_brick, Brick)) -->
    [ 'A brick ~w is connected already'-[Brick] ].
prolog:error_message(timeout_error(nxt(What), Brick)) -->
    [ 'Brick ~w did not answer ~w in time'-[Brick, What] ].
prolog:error_message(domain_error(nxt_request, What)) -->
    [ 'A brick does not support the request ~w'-[What] ].
prolog:error_message(nxt_error(Problem, Brick)) -->
    problem(Problem, Brick).

problem(refused(Status), Brick) -->
    [ 'Brick ~w refuses: ~w'-[Brick, Status] ].
problem(line_lost, Brick) -->
    [ 'The line to brick ~w was lost'-[Brick] ].
problem(garbage, Brick) -->
    [ 'The answer of brick ~w is invalid'-[Brick] ].
problem(open_failed, Brick) -->
    [ 'The port of brick ~w cannot be opened'-[Brick] ].
problem(low_battery(Volts), Brick) -->
    [ 'The battery of brick ~w is low: ~w'-[Brick, Volts] ].
problem(slow(Time), Brick) -->
    [ 'Brick ~w takes ~w to answer'-[Brick, Time] ].
problem(helper_died(stuck), Brick) -->
    [ 'The helper of brick ~w did not answer, and was killed'-[Brick] ].
problem(helper_died(Status), Brick) -->
    [ 'The helper of brick ~w ended: ~w'-[Brick, Status] ].
problem(Problem, Brick) -->
    [ 'Brick ~w: ~w'-[Brick, Problem] ].
