:- module(typhon_app_orders,
          [ order/3,                    % +Command, +Arguments, +Options
            program_argument/2,         % +Text, -Program
            host_now/2,                 % +Host, -Address
            agent_argument/3            % +Text, +Options, -Agent
          ]).

/** <module> Commands about running agents and hosts

order/3 has one clause for each command, and fails if the answer is negative.

*Threading*: the main thread.
*/

:- use_module(library(apply), [exclude/3, maplist/2, maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../prolog/typhon/kernel/base/monotonic', [poll_within/2]).
:- use_module('../../prolog/typhon',
              [ agent_check/1, agent_dispose/1, agent_join/3, agent_move/3,
                agent_property/2, host_property/2, remote/2 ]).
:- use_module('../../prolog/typhon/kernel/agent/identity', [agent_name/3]).
:- use_module('../../prolog/typhon/kernel/base/text',
              [format_shown/2, lines_shown/2]).
:- use_module('../../prolog/typhon/kernel/host/hosts', [address_parts/3]).
:- use_module('../../prolog/typhon/tools/inventory', [inventory/4]).

%!  order(+Command, +Arguments, +Options) is semidet.

order(check, Texts, _) :-
    maplist(program_argument, Texts, Programs),
    statistics(errors, Before),
    maplist(agent_check, Programs),
    statistics(errors, Before).         % no error was printed
order(dispose, [Text], Options) :-
    agent_argument(Text, Options, Agent),
    agent_dispose(Agent).
order(move, [Text, HostText], Options) :-
    agent_argument(Text, Options, Agent),
    host_argument(HostText, Agent, Host),
    option(timeout(Seconds), Options, 10),
    catch(agent_move(Agent, Host, [wait(Seconds)]),
          error(timeout_error(order, _), _),
          fail).
order(join, [Text], Options) :-
    agent_argument(Text, Options, Agent),
    option(timeout(Seconds), Options, 1.0e9),
    agent_join(Agent, Outcome, Seconds),
    format_shown('~q~n', [Outcome]),
    Outcome == done.
order(remote, [Host, Text], _) :-
    goal_argument(Text, Goal, Bindings),
    remote(Host, with_output_to(string(Output), Goal)),
    lines_shown(Output, Shown),
    write(Shown),
    forall(member(Name=Value, Bindings),
           format_shown('~w = ~q~n', [Name, Value])).
order(stop, [Host], Options) :-
    host_now(Host, Address),
    address_parts(Address, Name, _),
    request_stop(Host, Name),
    option(timeout(Seconds), Options, 20),
    poll_within(Seconds, is_gone(Host)).

%   A process started by the command line ends in order, as by a signal. The
%   answer may be lost with the process. A thread handle cannot be sent in an
%   answer.

request_stop(Host, Name) :-
    catch(remote(Host,
                 catch(typhon_app_serving:stop_requested(stop),
                       error(existence_error(procedure, _), _),
                       \+ \+ thread_create(typhon:host_stop(Name), _,
                                           [detached(true)]))),
          error(connection_lost(_), _),
          true).

                /*******************************
                *          ARGUMENTS           *
                *******************************/

%!  program_argument(+Text, -Program) is det.
%
%   A file, or a term as agents(census).

program_argument(Text, Text) :-
    exists_file(Text),
    !.
program_argument(Text, Program) :-
    sub_atom(Text, _, 1, 0, ')'),
    !,
    catch(term_to_atom(Program, Text),
          error(syntax_error(_), _),
          usage(not_a_term(Text))).
program_argument(Text, Text).

%!  agent_argument(+Text, +Options, -Agent) is det.
%
%   Agent is an id, or with host(Host) in Options the only agent with this name
%   in the network of Host.

agent_argument(Id, _, Agent) :-
    sub_atom(Id, _, _, _, @),
    !,
    Agent = Id.
agent_argument(Name, Options, Agent) :-
    option(host(Host), Options),
    !,
    seen_from(Host, Agents),
    findall(Id, ( member(Id, Agents), agent_name(Id, Name, _) ), Ids),
    only(Ids, Name, Host, Agents, Agent).
agent_argument(Name, _, _) :-
    usage(not_an_id(Name)).

seen_from(Host, Agents) :-
    inventory(1000000, [Host], Seen, _),
    findall(Id, ( member(seen(_, Here, _), Seen), member(agent(Id, _), Here) ),
            Ids),
    sort(Ids, Agents).

only([Agent], _, _, _, Agent) :-
    !.
only(Ids, _, _, _, Agent) :-
    exclude(is_faulty, Ids, [Agent]),   % a supervisor has replaced the others
    !.
only([], Name, Host, Agents, _) :-
    usage(no_agent(Name, Host, Agents)).
only(Ids, Name, _, _, _) :-
    usage(several_agents(Name, Ids)).

is_faulty(Agent) :-
    agent_property(Agent, state(faulty(_))).

%!  host_now(+Host, -Address) is det.
%
%   Address is the address of Host, which is reachable.
%
%   @error host_unreachable(Host), existence_error(host, Host)

host_now(Host, Address) :-
    catch(host_property(Host, address(Address)),
          error(host_unreachable(_), _),
          throw(error(host_unreachable(Host), _))),
    !.

%   An address, or the name of a host in the network of Agent.

host_argument(Address, _, Host) :-
    sub_atom(Address, _, _, _, @),
    !,
    Host = Address.
host_argument(Name, Agent, Host) :-
    agent_property(Agent, host(There)),
    !,
    inventory(0, [There], Seen, _),
    findall(Address,
            ( member(seen(Hosts, _, _), Seen),
              member(Known, Hosts),
              arg(1, Known, Address),
              address_parts(Address, Name, _) ),
            Addresses0),
    sort(Addresses0, Addresses),
    (   Addresses = [Host]
    ->  true
    ;   usage(not_one_host(Name, Addresses))
    ).
host_argument(_, Agent, _) :-
    throw(error(existence_error(agent, Agent), _)).

goal_argument(Text, Goal, Bindings) :-
    catch(term_string(Goal, Text, [variable_names(All)]),
          error(syntax_error(_), _),
          usage(not_a_term(Text))),
    exclude(hidden, All, Bindings).

hidden(Name=_) :-
    sub_atom(Name, 0, _, _, '_').

usage(Problem) :-
    throw(error(typhon_usage(Problem), _)).

                /*******************************
                *            WAITING           *
                *******************************/

%   A host needs some time to stop.

is_gone(Host) :-
    catch(\+ host_property(Host, state(_)),
          error(Formal, _),
          means_gone(Formal)).

means_gone(existence_error(host, _)).
means_gone(host_unreachable(_)).
means_gone(connection_lost(_)).
