:- module(typhon_node_process,
          [ order_do/2,                 % +Order, -Answer
            node_main/0
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- autoload(library(process), [process_kill/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/error_text', [print_error/2]).
:- use_module('../kernel/base/error_lines', [error_text/2]).
:- use_module('../kernel/base/process_setup',
              [on_stop_signals/1, process_setup/0]).
:- use_module('../kernel/base/durable', [durable_on/0]).
:- use_module('../kernel/wire',
              [ arrival_permitted/4, cookie_given/1, peer_expect/1,
                peer_expect_no_more/1, endpoint_address/1, endpoint_flush/2,
                endpoint_reply/2 ]).
:- use_module('../kernel/host',
              [ host/3, host_link/3, host_neighbours/2,
                host_option/2, host_restart/2, host_start/2, host_stop/1,
                host_unlink/2, hosts_go_on/0, hosts_rest/0, parent_secret/1,
                runtime_acquire/2, runtime_release/1, time_again/2,
                time_hold/1, time_let_go/1, time_state/1 ]).
:- use_module('../tools/administration', [host_property/2]).
:- autoload('../options/remote', [host_do/2]).
:- autoload('../options/fleet', [fleet_join/2]).
:- use_module('../options/journal', [hosts_back/1, hosts_journal/2]).
:- use_module('../options/snapshot',
              [ agents_at_rest/2, agents_go_on/1, process_dump/2,
                process_go_on/3, process_restore/2 ]).
:- use_module('../kernel/agent', [agent_name/3]).
:- use_module('../kernel/travel', [agent_outcome/2, home_agents/1]).
:- use_module(child_output, [output_begin/0, output_end/0]).

/** <module> A process that runs hosts of a network

A network gives orders about its hosts: by a call for hosts in its own process,
by a request for hosts in a child. One order takes whole lists, so that a
network of a thousand hosts needs few requests.

Module `children` starts a child as `swipl -g node_main node_process.pl`. The
first line of its standard input is node(Cookie, Secret, At, StopSeconds,
Keys, Options), where At is at(Interface, Advertised). When the endpoint listens, and the journal, if any, is restored, the
child prints one line:

    typhon_node_process <Interface>:<Port> <Pid>

If the child cannot start, the line is `typhon_node_process_error <Error>`, and
the process ends.

After that orders arrive over the wire, as requests of kind `node` with Secret. The process
stops in order when its standard input ends, or on SIGTERM, SIGINT and
SIGHUP: hosts stop first, then the process sends its output. The process ends at most
StopSeconds later, even if a thread hangs.

*Threading*: order_do/2 in any thread. In a child the main thread carries out
orders, one after another; only the order `alive` is answered by the thread of
the connection. One thread waits for the end of standard input. Another one
waits for the order to stop, and kills the process if it does not end in time.
*/

:- multifile
    prolog:error_message//1,
    typhon_endpoint:requested/4.

:- dynamic
    at_rest/0,                  % the order rest(_, _) has been carried out
    child/0.                    % this process is a child

:- setting(rest_seconds, number, 1,
           "Seconds for agents to come to rest when their network stops").

                /*******************************
                *            ORDERS            *
                *******************************/

%!  order_do(+Order, -Answer) is det.
%
%   Orders, whose answer is `ok` if none is named:
%
%     - hosts(Specs): start a host for each Name-Options, or, if one start
%       fails, none; the list of their addresses
%     - again(Specs): the same for hosts that existed before
%     - go_on: resume the contents of the journal of the process
%     - stop(Names): stop these hosts, if they exist.  If Names are all hosts of
%       the process, the journal keeps its contents
%     - stop: stop all hosts of the process in the same way
%     - flush(Seconds, Peers): `ok` when all that the process has sent to the
%       endpoints Peers has arrived, else `late`
%     - link(Halves), unlink(Halves): one direction of a link for each
%       half(Name, Address, Cost), see host_link/3
%     - places(Pairs): call the goal of each Name-Goal in the place of the host
%     - expect(Endpoints), expect_no_more(Endpoints): from now on a process at
%       one of Endpoints that ends will be restarted, or will not
%     - neighbours(Names): the list of the neighbours of each host, `[]` for a
%       host that does not exist
%     - hold(Seconds): pause time, so that no agent gets a turn; `ok` or `late`
%     - let_go: end hold(_)
%     - rest(Seconds, Peers): wait until no agent runs or is under way, and
%       nothing is queued for the endpoints Peers; `ok` or `late`
%     - kept(Names): kept(Time, Specs, Items): the state of time, see
%       time_state/1, Name-Options for each of these hosts, and the items of
%       process_dump/2
%     - fill(Kind, Items): restore Items
%     - goes_on(Kind, Time, Agents): restore the state of time, resume Agents
%     - agents: the agents that were created in the process and have not ended
%     - ended(Name): the ended agents named Name
%
%   @error errors of host_start/2, and of goals of places(Pairs); where such
%   a goal fails, place_goal_failed(Name, Goal)

order_do(hosts(Specs), Addresses) :-
    start_all(Specs, host_start, []),
    addresses(Specs, Addresses).
order_do(go_on, ok) :-
    hosts_go_on.
order_do(again(Specs), Addresses) :-
    start_all(Specs, host_restart, []),
    addresses(Specs, Addresses).
order_do(hold(Seconds), Answer) :-
    in_time(time_hold(Seconds), Answer).
order_do(rest(Seconds, Peers), Answer) :-
    in_time(agents_at_rest(Seconds, Peers), Answer),
    retractall(at_rest),
    assertz(at_rest).
order_do(kept(Names), kept(Time, Specs, Items)) :-
    time_state(Time),
    findall(Name-Options,
            ( member(Name, Names),
              findall(Option, host_option(Name, Option), Options) ),
            Specs),
    process_dump(Names, Items).
order_do(let_go, ok) :-
    retractall(at_rest),
    time_let_go(Agents),
    agents_go_on(Agents).
order_do(fill(Kind, Items), ok) :-
    process_restore(Kind, Items).
order_do(goes_on(Kind, Time, Agents), ok) :-
    time_again(Time, Scheduled),
    process_go_on(Kind, Agents, Scheduled).
order_do(stop(Names), ok) :-
    (   host(Other, _, _),
        \+ memberchk(Other, Names)
    ->  forall(member(Name, Names), stop_host(Name))
    ;   hosts_rest
    ).
order_do(stop, ok) :-
    hosts_rest.
order_do(flush(Seconds, Peers), Answer) :-
    in_time(endpoint_flush(Seconds, Peers), Answer).
order_do(link(Halves), ok) :-
    forall(member(half(Name, Address, Cost), Halves),
           host_link(Name, Address, Cost)).
order_do(unlink(Halves), ok) :-
    forall(member(half(Name, Address, _), Halves),
           host_unlink(Name, Address)).
order_do(places(Pairs), ok) :-
    forall(member(Name-Goal, Pairs), call_in_place(Name, Goal)).
order_do(expect(Endpoints), ok) :-
    forall(member(Endpoint, Endpoints), peer_expect(Endpoint)).
order_do(expect_no_more(Endpoints), ok) :-
    forall(member(Endpoint, Endpoints), peer_expect_no_more(Endpoint)).
order_do(neighbours(Names), Lists) :-
    maplist(host_neighbours, Names, Lists).
order_do(agents, Agents) :-
    home_agents(Agents).
order_do(ended(Name), Agents) :-
    findall(Agent,
            ( agent_outcome(Agent, _), agent_name(Agent, Name, _) ), Agents).

:- meta_predicate in_time(0, -).

in_time(Goal, Answer) :-
    (   call(Goal)
    ->  Answer = ok
    ;   Answer = late
    ).

addresses(Specs, Addresses) :-
    findall(Address,
            ( member(Name-_, Specs), host_property(Name, address(Address)) ),
            Addresses).

%   start_all(+Specs, :Start, +Started): if one host cannot start, stop those
%   that were started here, but not the hosts that the journal has restored.

start_all([], _, _).
start_all([Name-Options|Specs], Start, Started0) :-
    (   host(Name, _, _)
    ->  Started = Started0
    ;   Started = [Name|Started0]
    ),
    catch(call(Start, Name, Options), Error, true),
    (   var(Error)
    ->  start_all(Specs, Start, Started)
    ;   order_do(stop(Started0), ok),
        throw(Error)
    ).

call_in_place(Name, Goal) :-
    (   host_do(Name, Goal)
    ->  true
    ;   throw(error(place_goal_failed(Name, Goal), _))
    ).

stop_host(Name) :-
    catch(host_stop(Name), error(existence_error(host, _), _), true).

                /*******************************
                *            A CHILD           *
                *******************************/

%!  node_main
%
%   The main goal of a child.  Never returns: the process ends.

node_main :-
    process_setup,
    load_platform,
    set_stream(user_input, encoding(utf8)),
    set_stream(user_output, encoding(utf8)),
    set_stream(user_output, buffer(line)),
    read_term(user_input,
              node(Cookie, Secret, At, Seconds, Keys, Options), []),
    skip(user_input, 0'\n),     % resets the column that both streams share
    cookie_given(Cookie),
    with_keys(Keys),
    thread_create(ensure_end(Seconds), _,
                  [alias(typhon_end), detached(true)]),
    on_stop_signals(on_stop_signal),
    parent_secret(Secret),
    assertz(child),
    output_begin,
    catch(begin(At, Seconds, Options), error(Formal, Context),
          cannot_begin(Formal, Context)),
    endpoint_address(Endpoint),
    thread_create(watch_input, _, [alias(typhon_input), detached(true)]),
    current_prolog_flag(pid, Pid),
    format('typhon_node_process ~w ~d~n', [Endpoint, Pid]),
    flush_output,
    serve,
    stop.

%   Wait for the journal: the process that holds it may be about to end, like
%   the children of a process that has died.

begin(at(Interface, Advertised), Seconds, Options) :-
    forall(member(fleet(Fleet, Joins), Options), fleet_join(Fleet, Joins)),
    option(port(Port), Options, 0),
    Runtime = [bind(Interface), advertise(Advertised), port(Port)],
    (   option(journal(Directory, How), Options)
    ->  Wait is Seconds+1,
        hosts_journal(Directory, [sync(How), wait(Wait)]),
        runtime_acquire(node, Runtime),
        option(hosts(HostOptions), Options, []),
        hosts_back(HostOptions)
    ;   runtime_acquire(node, Runtime)
    ).

cannot_begin(Formal, Context) :-
    (   subsumes_term(context(_, _), Context),
        Context = context(_, Text),
        atomic(Text)
    ->  true
    ;   true
    ),
    format('typhon_node_process_error ~k~n', [error(Formal, context(_, Text))]),
    flush_output,
    halt(1).

with_keys(none).
with_keys(keys(Directory)) :-
    setenv('TYPHON_TLS', Directory).

%   Agents need the whole library; this module imports only the modules that it
%   calls.

load_platform :-
    (   exists_source(library(typhon))
    ->  true
    ;   module_property(typhon_node_process, file(File)),
        atom_concat(Library, '/typhon/network/node_process.pl', File),
        asserta(user:file_search_path(library, Library))
    ),
    use_module(library(typhon), []).

on_stop_signal(_) :-
    thread_send_message(typhon_end, stop).

%   The parent writes nothing more: wait for the end of standard input.

watch_input :-
    repeat,
    catch(get_char(user_input, Char), error(io_error(_, _), _),
          Char = end_of_file),
    Char == end_of_file,
    !,
    hold,
    thread_send_message(typhon_end, stop).

ensure_end(Seconds) :-
    thread_get_message(stop),
    thread_send_message(main, stop),
    sleep(Seconds),
    current_prolog_flag(pid, Pid),
    process_kill(Pid, kill).

typhon_endpoint:requested(node, order(_, Order), Peer, ReplyTo) :-
    child,
    arrival_permitted(order, node, Order, Peer),
    ordered(Order, ReplyTo).

ordered(alive, ReplyTo) :-
    !,
    endpoint_reply(ReplyTo, done(ok)).
ordered(Order, ReplyTo) :-
    thread_send_message(main, order(Order, ReplyTo)).

serve :-
    thread_get_message(Message),
    (   Message = order(Order, ReplyTo)
    ->  debug(typhon(network), 'order: ~W', [Order, [max_depth(2)]]),
        answer(Order, Answer),
        endpoint_reply(ReplyTo, Answer),
        serve
    ;   Message == stop
    ->  true
    ;   debug(typhon(network), 'unexpected message: ~p', [Message]),
        serve
    ).

%   The context of an error may hold terms that cannot be sent, so its text is
%   sent.

answer(Order, Answer) :-
    catch(answer_(Order, Answer), Error, raised(Error, Answer)).

answer_(Order, Answer) :-
    (   order_do(Order, Value)
    ->  Answer = done(Value)
    ;   Answer = raised(system_error(failed(Order)), "")
    ).

raised(Error, raised(Formal, Text)) :-
    error_text(Error, Text),
    (   Error = error(Formal, _)
    ->  true
    ;   Formal = system_error(Text)
    ).

%   Children whose parent has died end at about the same time.  Time is paused,
%   so that no agent observes that one of them ended first.

hold :-
    (   durable_on
    ->  ignore(time_hold(0))
    ;   true
    ).

come_to_rest :-
    at_rest,
    !.
come_to_rest :-
    hold,
    setting(rest_seconds, Seconds),
    ignore(agents_at_rest(Seconds, [])).

%   An error here cannot harm the contents of the journal, which are committed.

stop :-
    (   durable_on
    ->  output_end,
        come_to_rest
    ;   true
    ),
    catch(order_do(stop, ok), error(Formal, Context),
          print_error(warning, error(Formal, Context))),
    runtime_release(node),
    halt(0).

prolog:error_message(place_goal_failed(Host, Goal)) -->
    [ 'The goal for the place of ~w failed: ~p'-[Host, Goal] ].
