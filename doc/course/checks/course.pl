:- module(course,
          [ exercise/2,                 % ?Exercise, -Lesson
            criterion/3,                % ?Exercise, -Text, -Goal
            exercise_verdict/3,         % +Exercise, +File, -Verdict
            in_network/3,               % +Topology, +Options, :Goal
            on_host/3,                  % +File, +Host, -Agent
            on_host/4,                  % +File, +Host, +Facts, -Agent
            ended/2,                    % +Agent, -Result
            ended_between/5,            % +Agent, +Host, +Least, +Most, -Result
            arrived/2,                  % +Host, -Count
            time_passes/2,              % +Host, +Seconds
            facts_on/3,                 % +Host, +Template, -Facts
            expect/3                    % +What, +Found, +Expected
          ]).

/** <module> Common parts of the checks of all lessons

A check is a clause `course:criterion(Exercise, Text, Goal)`, in the file of
its lesson: call(Goal, File) is true if the program in File meets the criterion
that Text describes.  All runs are made in virtual time.

*Threading*: the main thread.
*/

:- use_module('../../../prolog/typhon').
:- use_module(library(option), [merge_options/3]).

:- meta_predicate in_network(+, +, 1).

:- multifile
    criterion/3,
    user:message_hook/3.
:- dynamic user:message_hook/3.
:- discontiguous criterion/3.

%   In virtual time there are no cells, see doc/security.md.

user:message_hook(typhon(no_cells(_, _)), warning, _).

%!  exercise(?Exercise, -Lesson) is nondet.
%
%   The program of Exercise is called Exercise.pl.

exercise(round, 1).
exercise(richest, 1).
exercise(tally, 1).
exercise(claim, 2).
exercise(forager, 2).
exercise(brigade, 2).
exercise(ring_leader, 3).
exercise(leader, 3).
exercise(contractor, 4).
exercise(manager, 4).
exercise(shopper, 4).
exercise(ant, 5).
exercise(parcel, 5).
exercise(fading_ant, 5).
exercise(patrol, 6).
exercise(patient, 6).
exercise(guard, 6).
exercise(warden, 7).
exercise(foreman, 7).
exercise(customer, 7).
exercise(speaker, 8).
exercise(line, 8).

%!  exercise_verdict(+Exercise, +File, -Verdict) is nondet.
%
%   Verdict is verdict(Text, Found) for each criterion; Found is `ok`, the
%   reason why it does not hold, or itself(Why) if the check does not work.

exercise_verdict(Exercise, File, verdict(Text, Found)) :-
    criterion(Exercise, Text, Goal),
    found(Goal, File, Found).

found(Goal, File, Found) :-
    catch(( call(Goal, File) -> Found = ok ; Found = "it does not" ),
          error(Formal, Context),
          found_error(Formal, Context, Found)).

%   Other errors than those of the program are mistakes of the check.

found_error(course_refused(Error), _, Text) :-
    !,
    message(Error, Text).
found_error(Formal, Context, Found) :-
    message(error(Formal, Context), Text),
    ( of_program(Formal) -> Found = Text ; Found = itself(Text) ).

of_program(course_expected(_, _, _)).
of_program(existence_error(agent, _)).  % it has ended too early

message(Error, Text) :-
    phrase(prolog:translate_message(Error), Lines),
    with_output_to(string(Text0),
                   print_message_lines(current_output, '', Lines)),
    split_string(Text0, "", " \n", [Text]).

%!  in_network(+Topology, +Options, :Goal) is semidet.
%
%   Calls Goal(Hosts) once in a guarded network in virtual time.  The quota of
%   seconds is one of real time, which says nothing on a slow machine.

in_network(Topology, Options0, Goal) :-
    merge_options(Options0,
                  [ clock(virtual), seed(1), log('/dev/null'),
                    hop_time(uniform(0.1, 0.2)),
                    hosts([policy(guarded), quota([seconds(100_000)])]) ],
                  Options),
    setup_call_cleanup(
        network_start(Topology, Network, Options),
        ( network_property(Network, hosts(Hosts)),
          once(call(Goal, Hosts)) ),
        network_stop(Network)).

%!  on_host(+File, +Host, -Agent) is det.
%!  on_host(+File, +Host, +Facts, -Agent) is det.
%
%   Agent begins to run the program in File on Host.

on_host(File, Host, Agent) :-
    on_host(File, Host, [], Agent).

on_host(File, Host, Facts, Agent) :-
    catch(agent_create(File, Agent, [host(Host), facts(Facts)]),
          error(Formal, Context),
          throw(error(course_refused(error(Formal, Context)), _))).

%!  ended(+Agent, -Result) is det.
%
%   Agent ends with `done`, and Result is its result.
%
%   @error course_expected(What, Found, Expected)

ended(Agent, Result) :-
    agent_join(Agent, Outcome, 10_000),
    expect('how it ends', Outcome, done),
    catch(agent_result(Agent, Result, 0),
          error(existence_error(result, _), _),
          expect('the result', none, a_result)).

%!  ended_between(+Agent, +Host, +Least, +Most, -Result) is det.
%
%   As ended/2; the time on Host is then between Least and Most.

ended_between(Agent, Host, Least, Most, Result) :-
    ended(Agent, Result),
    remote(Host, now(Time)),
    (   Time >= Least,
        Time =< Most
    ->  true
    ;   expect('the time of its end', Time, between(Least, Most))
    ).

%!  arrived(+Host, -Count:integer) is det.
%
%   So many agents have come to Host by hops.

arrived(Host, Count) :-
    host_property(Host, hop_time(in, Stats)),
    arg(1, Stats, Count).

%!  time_passes(+Host, +Seconds) is det.
%
%   So many seconds pass on Host, for all that is under way.

time_passes(Host, Seconds) :-
    agent_create(clauses([ (:- agent(clock, [])), (main :- sleep(Seconds)) ]),
                 Clock, [host(Host)]),
    Most is Seconds+1,
    agent_join(Clock, done, Most).

%!  facts_on(+Host, +Template, -Facts:list) is det.
%
%   The facts like Template that lie on Host, sorted.

facts_on(Host, Template, Facts) :-
    remote(Host, findall(Template, sense(Template), Facts0)),
    msort(Facts0, Facts).

%!  expect(+What, +Found, +Expected) is det.
%
%   @error course_expected(What, Found, Expected) if they do not unify

expect(_, Found, Expected) :-
    Found = Expected,
    !.
expect(What, Found, Expected) :-
    throw(error(course_expected(What, Found, Expected), _)).

:- multifile prolog:error_message//1.

prolog:error_message(course_expected(What, Found, Expected)) -->
    [ '~w is ~p, and should be ~p'-[What, Found, Expected] ].
