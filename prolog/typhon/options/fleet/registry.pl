:- module(typhon_registry, []).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/agent',
              [agent_here/5, agent_on/2, life_hops/2]).
:- use_module('../../kernel/base/bounds', [bounded/3]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/host', [host/3]).
:- use_module(engine, [engine_script/4]).
:- use_module(members, [fleet_host/3, fleet_joined/2]).

/** <module> Where the agents of a fleet are, and how they ended

The thread of a fleet compares the agents on its hosts with what it has
reported, once a second, and reports what is new in scripts of 500 agents.  So
a hop costs nothing here.  The engine keeps an agent below the home that its id
names: with all that is known of it, it is forgotten with its home.

*Threading*: the thread of the fleet reports; ends are noted in any thread.
*/

:- multifile
    typhon_join:known_end/2,
    typhon_join:known_results/2,
    typhon_members:is_new/1,
    typhon_members:work/1,
    typhon_on_demand:joins/2,
    typhon_whereabouts:ended_with/4,
    typhon_whereabouts:known_at/2.

:- setting(typhon_fleet:outcomes, positive_integer, 20000,
           "Ends of agents that a fleet keeps for each home, and a process until \c
            its fleet has them").
:- setting(typhon_fleet:outcome_length, positive_integer, 20000,
           "Characters of an outcome with its results; longer ones are kept \c
            without results").

:- dynamic
    reported/4,                 % Fleet, Id, Hops, Host
    ended/3,                    % Fleet, Id, Text
    unreported/2.               % Fleet, Id: of an end

typhon_on_demand:joins(fleet, joined).

                /*******************************
                *            REPORTS           *
                *******************************/

typhon_members:is_new(Fleet) :-
    retractall(reported(Fleet, _, _, _)),
    findall(Id, ended(Fleet, Id, _), Ids),
    forall(member(Id, Ids), must_report(Fleet, Id)).

must_report(Fleet, Id) :-
    bounded(unreported(_, _), typhon_fleet:outcomes,
            assertz(unreported(Fleet, Id))).

typhon_members:work(Fleet) :-
    report_until(Fleet, Until),
    findall(Id-Hops-Host, moved(Fleet, Id, Hops, Host), Moved),
    in_parts(500, Until, Moved, report_moves(Fleet)),
    forget_others(Fleet),
    findall(Id-Text, ( unreported(Fleet, Id), ended(Fleet, Id, Text) ), Ended),
    in_parts(500, Until, Ended, report_ends(Fleet)).

%   The thread renews a lease, too: of a slow engine each report asks little, and
%   the next one goes on.  The last one, of a fleet that is left, is whole.

report_until(Fleet, Until) :-
    (   fleet_joined(Fleet, Options),
        \+ option(engine(modelled), Options)
    ->  option(lease(Lease), Options, 3),
        deadline(Lease/6, Until)
    ;   Until = inf
    ).

moved(Fleet, Id, Hops, Host) :-
    fleet_host(Host, Fleet, _),
    agent_here(Id, Host, _, _, Life),
    life_hops(Life, Hops),
    \+ reported(Fleet, Id, Hops, Host).

:- meta_predicate in_parts(+, +, +, 1).

in_parts(N, Until, List, Report) :-
    monotonic_time(Now),
    (   ( List == [] ; Now > Until )
    ->  true
    ;   length(Part, N),
        append(Part, Rest, List)
    ->  call(Report, Part),
        in_parts(N, Until, Rest, Report)
    ;   call(Report, List)
    ).

report_moves(Fleet, Part) :-
    findall([Id,Hops,Address],
            ( member(Id-Hops-Host, Part), host(Host, Address, _) ),
            Lists),
    append(Lists, Args),
    engine_script(Fleet, where, Args, _),
    forall(member(Id-Hops-Host, Part),
           ( retractall(reported(Fleet, Id, _, _)),
             assertz(reported(Fleet, Id, Hops, Host)) )).

forget_others(Fleet) :-
    findall(Id, ( reported(Fleet, Id, _, _),
                  \+ agent_here(Id, _, _, _, _) ),
            Gone),
    forall(member(Id, Gone), retractall(reported(Fleet, Id, _, _))).

report_ends(Fleet, Part) :-
    findall([Id,Text], member(Id-Text, Part), Lists),
    append(Lists, Args),
    setting(typhon_fleet:outcomes, Most),
    engine_script(Fleet, ends, [Most|Args], _),
    forall(member(Id-_, Part), retractall(unreported(Fleet, Id))).

%   Hops is not needed: an agent ends once.

typhon_whereabouts:ended_with(Id, Outcome, _, Results) :-
    forall(fleet_joined(Fleet, _),
           ( end_text(Outcome, Results, Text), note_end(Fleet, Id, Text) )).

note_end(Fleet, Id, Text) :-
    bounded(ended(_, _, _), typhon_fleet:outcomes,
            assertz(ended(Fleet, Id, Text))),
    must_report(Fleet, Id).

end_text(Outcome, Results, Text) :-
    setting(typhon_fleet:outcome_length, Most),
    format(string(Text0), '~k', [end(Outcome, results(Results))]),
    (   string_length(Text0, Length),
        Length =< Most
    ->  Text = Text0
    ;   functor(Outcome, How, _),       % of a fault its text may be long
        format(string(Text), '~k', [end(How, none)])
    ).

                /*******************************
                *           QUESTIONS          *
                *******************************/

%   asked(+Kind, +Id, -Text): what some fleet of this process knows.

asked(Kind, Id, Text) :-
    fleet_joined(Fleet, _),
    engine_script(Fleet, known, [Kind,Id], Text),
    !.

typhon_whereabouts:known_at(Id, Address) :-
    fleet_joined(_, _),
    agent_on(Id, Host),
    host(Host, Address, _).
typhon_whereabouts:known_at(Id, Address) :-
    asked(agents, Id, Text),
    split_string(Text, " ", "", [_,Address0]),
    atom_string(Address, Address0).

typhon_join:known_end(Id, Outcome) :-
    end(Id, end(Outcome, _)).

typhon_join:known_results(Id, Results) :-
    end(Id, end(_, results(Results))).

%   What is here, or has ended here, is known at once, and elsewhere with the next report.

end(Id, End) :-
    (   ended(_, Id, Text)
    ->  true
    ;   asked(ends, Id, Text)
    ),
    term_string(End, Text).
