:- module(tartarus_lives,
          [ life_begin/4,               % +Name, +Location, +Handler, +Tokens
            life_begin/6,               % +Name, +Location, +Handler, +Tokens,
                                        % +Payload, +Clauses
            life_end/1,                 % +Name
            life_elsewhere/2            % +Name, +Life
          ]).
:- use_module(bodies, [body_copy/2, body_erase/2, body_install/1]).
:- use_module(platform, [port_closed/1]).
:- use_module(records,
              [ record/3, record_add/4, record_life/2, record_payload/2,
                record_remove/1, record_static/2, set_payload/2 ]).
:- use_module(threads, [when_through/2]).

/** <module> How agents begin and end on a platform

The record and the clauses of an agent come and go together.  An agent that moved
leaves its clauses behind until its last thread here is through: that may
need them.  They are not those of the agent any more: if it comes back
meanwhile, it brings its own.

*Threading*: any thread; one mutex.
*/

:- dynamic left/3.                      % Name, Id, Indicators: clauses that go

%!  life_begin(+Name, +Location, +Handler, +Tokens) is det.
%!  life_begin(+Name, +Location, +Handler, +Tokens, +Payload, +Clauses) is det.
%
%   An agent begins, from the template of its handler or with Clauses.  An
%   agent of that name ends.

life_begin(Name, Location, Handler, Tokens) :-
    with_mutex(tartarus_lives,
               ( anew(Name, Location, Handler, Tokens),
                 body_copy(Name, (Handler,3)) )).

life_begin(Name, Location, Handler, Tokens, Payload, Clauses) :-
    with_mutex(tartarus_lives,
               ( anew(Name, Location, Handler, Tokens),
                 set_payload(Name, Payload),
                 catch(body_install(Clauses), Ball,
                       ( life_end(Name), throw(Ball) )) )).

anew(Name, Location, Handler, Tokens) :-
    life_end(Name),
    sweep(Name, _),
    record_add(Name, Handler, Location, Tokens).

%!  life_end(+Name) is det.
%
%   Name, if it is here, ends.

life_end(Name) :-
    with_mutex(tartarus_lives, forget(Name, Indicators)),
    body_erase(Name, Indicators).

forget(Name, [(Handler,3)|Payload]) :-
    record(Name, Handler, _),
    !,
    record_payload(Name, Payload),
    forall(record_static(Name, Key), port_closed(Key)),
    record_remove(Name).
forget(_, []).

%!  life_elsewhere(+Name, +Life) is det.
%
%   Name goes on on another platform; or has come back from there already, and
%   has another life here.

life_elsewhere(Name, Life) :-
    flag(tartarus_left, Id, Id+1),
    (   with_mutex(tartarus_lives, leave(Name, Life, Id))
    ->  when_through(Name,
                     with_mutex(tartarus_lives,
                                tartarus_lives:sweep(Name, Id)))
    ;   true
    ).

leave(Name, Life, Id) :-
    record_life(Name, Life),
    forget(Name, Indicators),
    assertz(left(Name, Id, Indicators)).

sweep(Name, Id) :-
    retract(left(Name, Id, Indicators)),
    !,
    body_erase(Name, Indicators),
    sweep(Name, Id).
sweep(_, _).
