:- module(lasting_words,
          [ words/2                     % +Options, -Report
          ]).

/** <module> Numbered words, between agents whose processes are killed

A speaker sends numbered words to another agent, which echoes each; some
agents travel meanwhile, so words arrive in any order, but each once. The run
is complete when each agent has sent all its words, and received all echoes
and all words of its speaker; if it does not complete, the processes print
their pending data.

*Threading*: the main thread.
*/

:- use_module(ends).
:- use_module(nodes).
:- use_module('../../lib/common', [project_file/2, wait_until/2]).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, append/3, member/2, nth0/3]).
:- use_module(library(option), [option/3]).

%!  words(+Options, -Report) is det.
%
%   Options and Report as of lasting/2.

words(Options, report(Facts, Wrong)) :-
    option(seed(Seed), Options, 1),
    option(agents(Agents), Options, 12),
    option(hops(Each), Options, 300),
    set_random(seed(Seed)),
    get_time(Start),
    setup_call_cleanup(
        host_start(driver),
        with_nodes(Options, Nodes, said(Nodes, Options, Wrong), Told),
        host_stop(driver)),
    get_time(End),
    Seconds is End-Start,
    Hops is Agents*Each,
    Facts = [seconds(Seconds), hops(Hops)|Told].

said(Nodes, Options, Wrong) :-
    option(agents(Agents), Options, 12),
    option(hops(Each), Options, 300),
    option(seconds(Limit), Options, 100),
    maplist(node_host, Nodes, Hosts),
    findall(A, ( between(1, Agents, I), talker(I, Hosts, Each, A) ), Talkers),
    introduced(Talkers),
    get_time(Now),
    Deadline is Now+Limit,
    faults_begin(Options),
    agents_end(Talkers, Deadline, _),
    faults_end,
    Later is Deadline+Limit,            % on a slow machine
    agents_end(Talkers, Later, Ends),
    findall(W, wrong(Ends, W), Wrong0),
    evidence(Wrong0, Ends, Nodes, Wrong).

%   evidence(+Wrong0, +Ends, +Nodes, -Wrong): if anything is wrong, the facts
%   of the remaining agents, and, printed, the pending data of processes.

evidence([], _, _, []) :-
    !.
evidence(Wrong0, Ends, Nodes, Wrong) :-
    findall(A-Facts, ( member(A-End, Ends), End \== done, known(A, Facts) ),
            Left),
    append(Wrong0, Left, Wrong),
    nodes_check(Nodes),
    nodes_said(Nodes, Lines),
    forall(member(Line, Lines), format(user_error, '~w~n', [Line])).

known(Agent, Facts) :-
    catch(agent_property(Agent, facts(Facts)), error(Why, _), Facts = Why).

talker(I, Hosts, Each, Agent) :-
    length(Hosts, Count),
    J is I mod Count,
    nth0(J, Hosts, Host),
    append(Before, [Host|After], Hosts),
    append([After, Before, [Host]], Route),
    (   I mod 3 =:= 0
    ->  Travels = [route(Route)]
    ;   Travels = []
    ),
    project_file('test/chaos/lasting/agents/gossip.pl', File),
    agent_create(File, Agent, [host(Host), facts([todo(Each)|Travels])]).

introduced(Talkers) :-
    Talkers = [First|Others],
    append(Others, [First], Friends),
    forall(( nth0(I, Talkers, A), nth0(I, Friends, B) ),
           agent_send(A, friend(B))),
    wait_until(\+ ( member(A, Talkers), \+ has_friend(A) ), 60).

%   Messages of the driver are lost with a process, since the driver has no
%   journal.

has_friend(Agent) :-
    agent_property(Agent, facts(Facts)),
    memberchk(friend(_), Facts).

wrong(Ends, ended(Agent, End)) :-
    member(Agent-End, Ends),
    End \== done.
wrong(Ends, heard(Agent, What)) :-
    member(Agent-done, Ends),
    wait_until(catch(agent_result(Agent, What, 5), error(_, _), fail), 60),
    What \== [].
