:- module(typhon_metrics,
          [ processes_metrics/2         % +Hosts, -Text
          ]).
:- use_module(library(aggregate), [aggregate/3, aggregate_all/3]).
:- use_module(library(dcg/high_order), [sequence//2, sequence//3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module('../../kernel/program', [code_program/2]).
:- use_module('../../kernel/wire', [endpoint_address/1, endpoint_peer/2]).
:- use_module('../../kernel/host',
              [events_subscribe/3, events_unsubscribe/1, host/3]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3]).
:- use_module('../../tools/administration', [status_shown/2]).
:- use_module(watched_hosts, [ask_processes/5, watched_places/2]).

/** <module> Metrics of a network, for Prometheus

Each process reports its own numbers, which are not added up here.  A process
counts from the first request for metrics on, as long as it has an endpoint.

*Threading*: any thread that may wait.  Counters are flags.
*/

:- multifile
    typhon_events:handle_event/4,
    typhon_watched_hosts:answer/2,
    typhon_hosting:begins/1,
    typhon_runtime:ending/1.

%!  processes_metrics(+Hosts, -Text:string) is det.
%
%   See metrics/2.

processes_metrics(Hosts, Text) :-
    watched_places(Hosts, Places),
    ask_processes(Places, numbers, 5, Answers, Silent),
    findall(Endpoint-Numbers,
            member(place(Endpoint, _, _)-Numbers, Answers),
            Processes),
    findall(metric(Name, Type, Help, Samples),
            ( described(Name, Type, Help),
              findall(Sample, sample(Name, Processes, Silent, Sample),
                      Samples) ),
            Metrics),
    phrase(sequence(metric, Metrics), Codes),
    string_codes(Text, Codes).

described(typhon_up, gauge,
          'Whether the process has answered.').
described(typhon_hosts, gauge,
          'Running hosts.').
described(typhon_agents, gauge,
          'Agents on the hosts, by program and state.').
described(typhon_connections, gauge,
          'Addresses of other processes to which there is a connection.').
described(typhon_agents_created_total, counter,
          'Agents that have begun, including clones.').
described(typhon_agents_ended_total, counter,
          'Agents that have ended.').
described(typhon_faults_total, counter,
          'Agents that became faulty.').
described(typhon_messages_total, counter,
          'Messages that agents have sent, and have received.').
described(typhon_hop_seconds, histogram,
          'Duration of hops until the arrival, by the clock of the host.').

sample(typhon_up, Processes, Silent, sample('', [process=Endpoint], Up)) :-
    (   member(Endpoint-_, Processes),
        Up = 1
    ;   member(Endpoint, Silent),
        Up = 0
    ).
sample(Name, Processes, _, sample(Suffix, [process=Endpoint|Labels], Value)) :-
    member(Endpoint-Numbers, Processes),
    member(number(Name, Suffix, Labels, Value), Numbers).

                /*******************************
                *          ONE PROCESS         *
                *******************************/

typhon_watched_hosts:answer(numbers, Numbers) :-
    counting_begin,
    findall(number(Name, Suffix, Labels, Value),
            number(Name, Suffix, Labels, Value),
            Numbers).

number(typhon_hosts, '', [], Count) :-
    aggregate_all(count, host(_, _, _), Count).
number(typhon_agents, '', [program=Program, state=State], Count) :-
    aggregate(count, agent_counted(Program, State), Count).
number(typhon_connections, '', [], Count) :-
    aggregate_all(count,
                  ( endpoint_peer(Address, state(up)),
                    \+ endpoint_address(Address) ),
                  Count).
number(typhon_agents_created_total, '', [], Count) :-
    counted(created, Count).
number(typhon_agents_ended_total, '', [], Count) :-
    counted(ended, Count).
number(typhon_faults_total, '', [], Count) :-
    counted(faults, Count).
number(typhon_messages_total, '', [direction=Direction], Count) :-
    member(Direction, [sent, received]),
    counted(Direction, Count).
number(typhon_hop_seconds, Suffix, Labels, Value) :-
    counted_hops(Buckets, Sum),
    last(Buckets, _-Count),
    (   member(Bound-Value, Buckets),
        Suffix = '_bucket',
        bound_text(Bound, Text),
        Labels = [le=Text]
    ;   Suffix = '_sum', Labels = [], Value = Sum
    ;   Suffix = '_count', Labels = [], Value = Count
    ).

bound_text(inf, '+Inf') :-
    !.
bound_text(Bound, Bound).

%   An agent whose status changes meanwhile must not be counted twice.

agent_counted(Program, State) :-
    agent(Id, _, _, Hash, _),
    code_program(Hash, program(Program, _, _, _)),
    once(agent_status(Id, Status, _)),
    once(status_shown(Status, Shown)),
    functor(Shown, State, _).

                /*******************************
                *           COUNTING           *
                *******************************/

:- dynamic counting/0.

counting_begin :-
    counting,
    !.
counting_begin :-
    with_mutex(typhon_counting, begin).

begin :-
    counting,
    !.
begin :-
    assertz(counting),
    forall(host(Name, _, _), count_events(Name)).

count_events(Name) :-
    events_subscribe([life, faults, hops, messages], Name, count).

typhon_hosting:begins(Name) :-
    counting,
    count_events(Name).

typhon_runtime:ending(after) :-
    retractall(counting),
    events_unsubscribe(count).

typhon_events:handle_event(count, _, _, What) :-
    count(What).

count(arrived(_, Seconds)) =>
    bound(Bound, Key),
    Seconds =< Bound,
    !,
    flag(Key, N, N+1),
    bump(seconds, Seconds).
count(sent(_, _)) =>
    bump(sent, 1).
count(received(_, _)) =>
    bump(received, 1).
count(fault(_)) =>
    bump(faults, 1).
count(created) =>
    bump(created, 1).
count(ended(_)) =>
    bump(ended, 1).
count(_) =>
    true.

bump(What, By) :-
    key(What, Key),
    flag(Key, N, N+By).

key(seconds, 'typhon count seconds').
key(sent, 'typhon count sent').
key(received, 'typhon count received').
key(faults, 'typhon count faults').
key(created, 'typhon count created').
key(ended, 'typhon count ended').

%   bound(?Seconds, ?Key): Key counts hops that took at most Seconds, and longer
%   than the bound before.

bound(0.0001, 'typhon count hops 1').
bound(0.00025, 'typhon count hops 2').
bound(0.0005, 'typhon count hops 3').
bound(0.001, 'typhon count hops 4').
bound(0.0025, 'typhon count hops 5').
bound(0.005, 'typhon count hops 6').
bound(0.01, 'typhon count hops 7').
bound(0.05, 'typhon count hops 8').
bound(0.1, 'typhon count hops 9').
bound(0.5, 'typhon count hops 10').
bound(1.0, 'typhon count hops 11').
bound(10.0, 'typhon count hops 12').
bound(inf, 'typhon count hops 13').

counted(What, Count) :-
    key(What, Key),
    What \== seconds,
    flag(Key, Count, Count).

%   counted_hops(-Buckets, -Sum): Buckets are Bound-Count: Count hops took at
%   most Bound seconds, a number or `inf`, by the clock of the host; Sum is the
%   total duration of all hops.

counted_hops(Buckets, Sum) :-
    findall(Bound-Count,
            ( bound(Bound, Key), flag(Key, Count, Count) ), Counts),
    cumulated(Counts, 0, Buckets),
    key(seconds, SumKey),
    flag(SumKey, Sum, Sum).

cumulated([], _, []).
cumulated([Bound-Own|Counts], Count0, [Bound-Count|Buckets]) :-
    Count is Count0+Own,
    cumulated(Counts, Count, Buckets).

%   metric(+Metric)//: Metric is metric(Name, Type, Help, Samples).  A sample is
%   sample(Suffix, Labels, Value): Suffix, as `_bucket`, is appended to the name
%   of the metric; Labels are pairs Name=Term; Value is a number.

metric(metric(_, _, _, [])) -->
    !.
metric(metric(Name, Type, Help, Samples)) -->
    "# HELP ", text(Name), " ", text(Help), "\n",
    "# TYPE ", text(Name), " ", text(Type), "\n",
    sequence(line(Name), Samples).

line(Name, sample(Suffix, Labels, Value)) -->
    text(Name), text(Suffix), labels(Labels), " ", text(Value), "\n".

labels([]) -->
    !.
labels(Labels) -->
    "{", sequence(label, ",", Labels), "}".

label(Name=Value) -->
    { format(codes(Codes), '~w', [Value]) },
    text(Name), "=\"", sequence(escape, Codes), "\"".

escape(0'\\) --> !, "\\\\".
escape(0'") --> !, "\\\"".
escape(0'\n) --> !, "\\n".
escape(Code) --> [Code].

text(Text, Codes, Rest) :-
    format(codes(Codes, Rest), '~w', [Text]).
