:- module(typhon_metrics,
          [ processes_metrics/2         % +Hosts, -Text
          ]).
:- use_module(library(aggregate), [aggregate/3, aggregate_all/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module('../../kernel/program', [code_program/2]).
:- use_module('../../kernel/wire', [endpoint_address/1, endpoint_peer/2]).
:- use_module('../../kernel/host', [host/3]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3]).
:- use_module('../../kernel/lifecycle', [status_shown/2]).
:- use_module(counting, [counted/2, counted_hops/2, counting_begin/0]).
:- use_module(everywhere, [everywhere/5]).
:- use_module(prometheus, [exposition/3]).
:- use_module(watched, [watched_places/2]).

/** <module> A network in numbers, for Prometheus

Each process says its own numbers: whoever reads them adds them up.

*Threading*: any thread that may wait.
*/

:- multifile typhon_everywhere:answer/2.

%!  processes_metrics(+Hosts, -Text:string) is det.
%
%   See metrics/2.

processes_metrics(Hosts, Text) :-
    watched_places(Hosts, Places),
    everywhere(Places, numbers, 5, Answers, Silent),
    findall(Endpoint-Numbers,
            member(place(Endpoint, _, _)-Numbers, Answers),
            Processes),
    findall(metric(Name, Type, Help, Samples),
            ( described(Name, Type, Help),
              findall(Sample, sample(Name, Processes, Silent, Sample),
                      Samples) ),
            Metrics),
    phrase(exposition(Metrics), Codes),
    string_codes(Text, Codes).

described(typhon_up, gauge,
          'Whether the process has answered.').
described(typhon_hosts, gauge,
          'Hosts that run.').
described(typhon_agents, gauge,
          'Agents that are there, by program and state.').
described(typhon_connections, gauge,
          'Addresses of other processes to which there is a connection.').
described(typhon_agents_created_total, counter,
          'Agents that have begun, clones among them.').
described(typhon_agents_ended_total, counter,
          'Agents that have ended.').
described(typhon_faults_total, counter,
          'Agents that became faulty.').
described(typhon_messages_total, counter,
          'Messages that agents have sent, and have taken.').
described(typhon_hop_seconds, histogram,
          'How long hops took until they were there, by the clock of the host.').

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

typhon_everywhere:answer(numbers, Numbers) :-
    counting_begin,
    findall(number(Name, Suffix, Labels, Value),
            number(Name, Suffix, Labels, Value),
            Numbers).

number(typhon_hosts, '', [], Count) :-
    aggregate_all(count, host(_, _, _), Count).
number(typhon_agents, '', [program=Program, state=State], Count) :-
    aggregate(count, agent_is(Program, State), Count).
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

%   An agent is counted once, also where it changes meanwhile.

agent_is(Program, State) :-
    agent(Id, _, _, Hash, _),
    code_program(Hash, program(Program, _, _, _)),
    once(agent_status(Id, Status, _)),
    once(status_shown(Status, Shown)),
    functor(Shown, State, _).
