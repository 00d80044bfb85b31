:- module(chaos_facts,
          [ facts_load/1,               % +Evidence
            facts_clear/0,
            life/4,                     % ?Name, ?Number, ?From, ?To
            created/5,                  % ?Key, ?Kind, ?Id, ?Life, ?Time
            standing/5,                 % ?Id, ?Name, ?State, ?Hops, ?Facts
            event/5,                    % ?Key, ?Tick, ?Event, ?Time, ?Life
            disposed/2,                 % ?Key, ?Time
            outcome/2,                  % ?Id, ?Outcome
            alive/1,                    % +Life
            death_of/2,                 % ?Name, -Time
            undone/3,                   % ?Key, ?Event, ?Tick
            clone_key/3                 % +Parent, +Number, -Key
          ]).

/** <module> Tables of the facts of a run

A life, of a process, is Name-Number.  Clones are among the created agents:
their parents report them.

*Threading*: for one thread at a time.
*/

:- use_module(library(lists), [member/2]).

:- dynamic
    life/4,                             % Name, Number, From, To
    created/5,                          % Key, Kind, Id, Life, Time
    standing/5,                         % Id, Name, State, Hops, Facts
    event/5,                            % Key, Tick, Event, Time, Life
    disposed/2,                         % Key, Time
    outcome/2.                          % Id, Outcome

%!  facts_load(+Evidence) is det.
%!  facts_clear is det.
%
%   Evidence as of chaos_evidence.

facts_load(Evidence) :-
    facts_clear,
    forall(member(Life, Evidence.lives), assertz(Life)),
    forall(member(agent(K, Kind, Id, L, T), Evidence.agents),
           assertz(created(K, Kind, Id, L, T))),
    forall(member(agent(Name, Id, State, Hops, Facts), Evidence.standing),
           assertz(standing(Id, Name, State, Hops, Facts))),
    forall(member(e(K, N, E, T, L), Evidence.events),
           assertz(event(K, N, E, T, L))),
    forall(( event(P, _, clone(N, Id), T, L), clone_key(P, N, K) ),
           ( begun(P, N, T, Begun),
             assertz(created(K, clone, Id, L, Begun)) )),
    forall(member(K-T, Evidence.disposed), assertz(disposed(K, T))),
    forall(member(Id-O, Evidence.outcomes), assertz(outcome(Id, O))).

facts_clear :-
    forall(member(Fact, [ life(_, _, _, _), created(_, _, _, _, _),
                          standing(_, _, _, _, _), event(_, _, _, _, _),
                          disposed(_, _), outcome(_, _) ]),
           retractall(Fact)).

%   A clone may begin and end before its parent is notified.

begun(Parent, N, Heard, Begun) :-
    (   event(Parent, _, cloning(N), Time, _)
    ->  Begun = Time
    ;   Begun = Heard
    ).

clone_key(Parent, N, Key) :-
    atomic_list_concat([Parent, +, N], Key).

%!  alive(+Life) is semidet.
%!  death_of(?Name, -Time) is nondet.
%
%   Life has not ended yet; a life of Name ended at Time.

alive(Name-Number) :-
    life(Name, Number, _, inf).

death_of(Name, Time) :-
    life(Name, _, _, Time),
    number(Time).

%!  undone(?Key, ?Event, ?Tick) is nondet.
%
%   The agent Key has done Event, its step Tick, in a process that has died
%   since, and has continued elsewhere in its state before that step.

undone(Key, Event, Tick) :-
    event(Key, Tick, Event, Time, Life),
    \+ alive(Life),
    once(goes_on_before(Key, Tick, Time)).

goes_on_before(Key, Tick, Time) :-
    event(Key, Before, _, Later, _),
    Before =< Tick,
    Later > Time.
goes_on_before(Key, Tick, _) :-
    created(Key, _, Id, _, _),
    standing(Id, _, _, _, Facts),
    memberchk(tick(Before), Facts),
    Before < Tick.
