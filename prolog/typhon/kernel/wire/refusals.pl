:- module(typhon_refusals,
          [ refused/2,                  % +Ip, +Why
            refusals_begin/0
          ]).

/** <module> Reporting refused connections

A port scan or a flood must not fill the log, and must not go unnoticed. The
first few refusals of a burst are reported one by one; for the rest one message
a second reports their number, addresses and reasons. A burst is over after a
second without refusals.

*Threading*: any thread; a mutex guards the counts. The connection manager calls
report/0 when a second is over.
*/

:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [member/2]).
:- use_module(threads, [manager_notify/1]).
:- use_module(transport, [refusal_text/2]).

:- dynamic
    burst/1,                            % Reported: number reported one by one
    tally/3.                            % Ip, Why, Count: not yet reported

%   The most that are reported one by one, and the most pairs of address and
%   reason.

singly(5).
groups(16).

%!  refused(+Ip, +Why) is det.
%
%   A client at Ip was refused. Why is the formal term of an error,
%   `silent` (its slot was needed), `crowd` (there was no slot), or
%   version(V).

refused(Ip, Formal) :-
    reason(Formal, Why),
    sig_atomic(with_mutex(typhon_refusals, note(Ip, Why, How))),
    (   How == alone
    ->  level(Why, Level),
        print_message(Level, typhon(endpoint, turned_away(Ip, Why)))
    ;   true
    ).

note(Ip, Why, How) :-
    (   burst(Reported)
    ->  true
    ;   Reported = 0,
        assertz(burst(0)),
        plan
    ),
    singly(Max),
    (   Reported < Max
    ->  How = alone,
        retractall(burst(_)),
        Reported1 is Reported+1,
        assertz(burst(Reported1))
    ;   How = together,
        add(Ip, Why)
    ).

add(Ip, Why) :-
    retract(tally(Ip, Why, Count0)),
    !,
    Count is Count0+1,
    assertz(tally(Ip, Why, Count)).
add(Ip, Why) :-
    predicate_property(tally(_, _, _), number_of_clauses(Groups)),
    groups(Max),
    (   ( Groups < Max ; Ip-Why == others-several )
    ->  assertz(tally(Ip, Why, 1))
    ;   add(others, several)
    ).

plan :-
    get_time(Now),
    Time is Now+1,
    ignore(manager_notify(later(Time, typhon_refusals:report))).

%!  refusals_begin is det.
%
%   An endpoint begins: report what is left, and begin a new burst.

refusals_begin :-
    report,
    retractall(burst(_)).

%   Report the refusals that were not reported one by one.

report :-
    sig_atomic(with_mutex(typhon_refusals, take(Groups))),
    (   Groups == []
    ->  true
    ;   (   member(_-(_-Why), Groups), level(Why, warning)
        ->  Level = warning
        ;   Level = informational
        ),
        print_message(Level, typhon(endpoint, turned_away(Groups)))
    ).

take(Groups) :-
    findall(Count-(Ip-Why), tally(Ip, Why, Count), Groups0),
    retractall(tally(_, _, _)),
    sort(1, @>=, Groups0, Groups),
    (   Groups == []
    ->  retractall(burst(_))
    ;   plan
    ).

%   reason(+Formal, -Why): Why has no details that differ from case to case.

reason(permission_error(authenticate, peer, Why), Why) :-
    !.
reason(syntax_error(end_of_file), hung_up) :-
    !.
reason(syntax_error(Why), Why) :-
    !.
reason(timeout_error(_, _), slow) :-
    !.
reason(io_error(_, _), broken) :-
    !.
reason(socket_error(_, _), broken) :-
    !.
reason(Why, Why).

level(Why, Level) :-
    (   memberchk(Why, [hung_up, broken])
    ->  Level = informational
    ;   Level = warning
    ).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, turned_away(Ip, Why))) -->
    [ 'Endpoint: refused a client at ~w: '-[Ip] ],
    why(Why).
prolog:message(typhon(endpoint, turned_away(Groups))) -->
    { foldl([Count-_, Sum0, Sum]>>(Sum is Sum0+Count), Groups, 0, Sum) },
    [ 'Endpoint: refused ~D more clients:'-[Sum] ],
    groups(Groups).

groups([]) -->
    [].
groups([Count-(Ip-Why)|Groups]) -->
    [ nl, '  ~D at ~w: '-[Count, Ip] ],
    why(Why),
    groups(Groups).

why(version(Version)) -->
    !, [ 'it speaks another version of the protocol, ~w'-[Version] ].
why(Why) -->
    { ours(Why, Text) ; refusal_text(Why, Text) },
    !, [ '~w'-[Text] ].
why(Why) -->
    [ '~p'-[Why] ].

ours(cookie, 'its cookie is not that of this process').
ours(protocol, 'it uses another protocol').
ours(hung_up, 'it closed the connection').
ours(broken, 'the connection broke').
ours(slow, 'it did not complete the handshake in time').
ours(silent, 'its slot was given to another client').
ours(crowd, 'all slots are taken').
ours(line, 'it sent a line that is too long').
ours(other, 'it claims to be another process').
ours(several, 'for several reasons').
