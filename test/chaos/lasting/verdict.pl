:- module(lasting_verdict,
          [ wrong/6                     % +People, +Ends, +Hosts, +Each,
                                        % +Deadline, -Wrong
          ]).

/** <module> Violations at the end of a run

*Threading*: the main thread.
*/

:- use_module('../../../prolog/typhon').
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module('../../lib/common', [wait_until/2]).

:- meta_predicate again(0).

%!  wrong(+People, +Ends, +Hosts, +Each, +Deadline, -Wrong) is nondet.
%
%   Wrong is a violation: the agents People, each of which had to hop Each
%   times, have these Ends.  Messages may come until Deadline.  If an agent has
%   not ended that is all: the rest would be waited for in vain.

wrong(People, Ends, Hosts, Each, Deadline, Wrong) :-
    (   member(Agent-End, Ends),
        End \== done
    *-> Wrong = ended(Agent, End)
    ;   wrong(People, Hosts, Each, Deadline, Wrong)
    ).

wrong(people(Hoppers, _, _, _), _, Each, _, result(Agent, Result)) :-
    member(Agent, Hoppers),
    result_of(Agent, Result),
    Result \== made(Each).
wrong(people(Hoppers, _, _, _), Hosts, Each, _, visits(Sum, Expected)) :-
    length(Hoppers, Count),
    Expected is Count*(Each//4),
    findall(V, ( member(H, Hosts), visits(H, V) ), Vs),
    sum_list(Vs, Sum),
    Sum =\= Expected.
wrong(_, Hosts, _, _, tokens(Found, Expected)) :-
    findall(T, ( member(H, Hosts), tokens(H, Ts), member(T, Ts) ), Found0),
    msort(Found0, Found),
    findall(H-I, ( member(H, Hosts), between(1, 3, I) ), Expected0),
    msort(Expected0, Expected),
    Found \== Expected.
wrong(people(Hoppers, _, Talkers, Sinks), _, Each, Deadline, Wrong) :-
    settled(Sinks, Hoppers, Talkers, Each, Deadline, Facts),
    wrong_mail(Facts, Hoppers, Talkers, Each, Wrong).
wrong(_, Hosts, _, _, left(H, Source)) :-
    member(H, Hosts),
    \+ catch(wait_until(( left(H, Now), Now == [] ), 20), error(_, _), fail),
    left(H, Source),
    Source \== [].

%   The old process may still be queried for an agent that has moved on.

left(Host, Source) :-
    again(remote(Host, findall(A-S, ( typhon:agent_property(A, state(S)),
                                      \+ typhon:agent_property(A, program(sink))
                                    ), Source))).

result_of(Agent, Result) :-
    again(catch(( agent_result(Agent, Result0, 5) -> true
                ; Result0 = late ),
                error(existence_error(result, _), _), Result0 = none)),
    Result = Result0.

visits(Host, V) :-
    again(remote(Host, findall(X, sense(visits(X)), Vs))),
    sum_list(Vs, V).

tokens(Host, Ts) :-
    again(remote(Host, findall(T, sense(token(T)), Ts))).

settled(Sinks, Hoppers, Talkers, Each, Deadline, Facts) :-
    findall(F, ( member(S, Sinks), facts(S, Fs), member(F, Fs) ), Facts0),
    get_time(Now),
    (   \+ wrong_mail(Facts0, Hoppers, Talkers, Each, _)
    ->  Facts = Facts0
    ;   Now > Deadline
    ->  Facts = Facts0
    ;   thread_self(Me),
        (   thread_get_message(Me, '$never', [timeout(0.2)])
        ->  true
        ;   true
        ),
        settled(Sinks, Hoppers, Talkers, Each, Deadline, Facts)
    ).

facts(Sink, Facts) :-
    again(agent_property(Sink, facts(Facts))).

wrong_mail(Facts, _, _, _, order(Source, N0, N)) :-
    member(wrong(Source, N0, N), Facts).
wrong_mail(Facts, Hoppers, _, Each, hops(Source, Count-Sum)) :-
    member(Source, Hoppers),
    (   member(hops(Source, Count, Sum), Facts)
    ->  true
    ;   Count = 0, Sum = 0
    ),
    Told is Each//4,
    Expected is 4*Told*(Told+1)//2,
    Count-Sum \== Told-Expected.
wrong_mail(Facts, _, Talkers, Each, heard(Source, N)) :-
    member(Source, Talkers),
    ( member(heard(Source, N), Facts) -> true ; N = 0 ),
    N =\= min(Each, 200).

%   The process may be restarting at the moment.

again(Goal) :-
    wait_until(catch(Goal, error(_, _), fail), 60).
