:- module(typhon_inventory,
          [ inventory/4,                % +Most, +Places, -Seen, -Silent
            inventory_hosts/4,          % +Places, +Seen, +Silent, -Hosts
            inventory_agents/2,         % +Seen, -Agents
            inventory_order/2,          % +Text, -Key
            host_report/2               % +Host, -Report
          ]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(dcg/basics), [digits//1, string_without//2]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(pairs), [map_list_to_pairs/3, pairs_values/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../kernel/base/error_text', [abridged/3]).
:- use_module('../kernel/base/text', [print_clause/3]).
:- use_module('../kernel/host',
              [ address_parts/3, clock/3, host/3, host_link_cost/3,
                host_option/2, host_resolve/2,
                host_unknown/1, process_ask/6, scheduler_call/1, time_kind/1,
                tuple_sense/2 ]).
:- use_module(administration, [host_property/2]).
:- use_module(agent_summary, [agent_summary/2]).
:- use_module('../kernel/wire',
              [ endpoint_address/1, endpoint_ask_all/6, endpoint_left/1,
                endpoint_reply/2 ]).
:- use_module('../network', [network_hosts/2]).
:- use_module('../options/directory', [host_offers/2]).

/** <module> Inventory of the processes of a network, and of one host

Each process reports its hosts and the agents on them in one answer.  Requests
go to all processes of networks that this process has started, and of hosts that
links lead to, at the same time.  A process that has not answered by the
deadline is silent.

The report on one host has the facts in its tuple space, the clauses of its
place and its options, as text.  Long values are shortened.

*Threading*: any thread that may wait, except threads of the endpoint.  A worker
answers a request, since the answer may be long.
*/

:- setting(seconds, number, 2,
           "Seconds for which a table waits for other processes of a network").

:- multifile
    typhon_endpoint:requested/4.

%!  inventory(+Most, +Places, -Seen, -Silent) is det.
%
%   Seen has a term seen(Hosts, Agents, Count) for each process that has
%   answered:
%
%     - Hosts are terms host(Address, State, Load, Capacity, Arrived,
%       Neighbours, Costs, Clock).  Costs are the costs of the links to
%       Neighbours, in their order.  Clock is clock(Epoch, Rate) or `virtual`
%     - Agents are terms agent(Id, Glance), see agent_summary/2: the first Most
%       of Count agents, in the order of inventory_order/2.  If Most is 0 they
%       are not counted
%
%   The inventory includes this process, the processes of networks that it has
%   started, those at the addresses Places, and others to which links of their
%   hosts lead. Silent are pairs Endpoint-Why of the processes without an
%   answer, where Why is `gone`, `lost` or `late`.

inventory(Most, Places, [Here|Seen], Silent) :-
    own_inventory(Most, Here),
    findall(Address, ( member(Address, Places) ; known(Address) ), Known),
    further_places(Here, Linked),
    append(Known, Linked, Addresses),
    other_processes(Addresses, Others),
    ask(Others, Most, Results),
    answers(Results, Seen),
    findall(Endpoint-Why,
            ( member(Endpoint-Result, Results), silence(Result, Why) ),
            Silent0),
    sort(Silent0, Silent).

%   A process that listens at several ports answers at each of them.

answers(Results, Seen) :-
    findall(Names-Answer,
            ( member(_-answer(Answer), Results),
              Answer = seen(Hosts, _, _),
              maplist(arg(1), Hosts, Names) ),
            Pairs0),
    sort(1, @<, Pairs0, Pairs),
    pairs_values(Pairs, Seen).

silence(gone, gone).
silence(unreachable, gone).
silence(lost, lost).
silence(late, late).

known(Address) :-
    network_hosts(_, Addresses),
    member(Address, Addresses).

%   A process that is known to have left gets no request.

ask(Endpoints, Most, Results) :-
    findall(Endpoint-gone,
            ( member(Endpoint, Endpoints), endpoint_left(Endpoint) ), Gone),
    exclude(endpoint_left, Endpoints, There),
    ask_there(There, Most, Answers),
    append(Gone, Answers, Results).

ask_there([], _, []) :-
    !.
ask_there(Endpoints, Most, Results) :-
    setting(seconds, Seconds),
    endpoint_ask_all(Endpoints, survey, look(Most),
                     typhon_inventory:further, Seconds, Results).

further(Seen, Endpoints) :-
    further_places(Seen, Addresses),
    other_processes(Addresses, Endpoints).

further_places(seen(Hosts, _, _), Addresses) :-
    findall(Address,
            ( member(host(_, _, _, _, _, Neighbours, _, _), Hosts),
              member(Address, Neighbours) ),
            Addresses).

other_processes(Addresses, Endpoints) :-
    findall(Endpoint,
            ( member(Address, Addresses),
              address_parts(Address, _, Endpoint),
              \+ endpoint_address(Endpoint) ),
            Endpoints0),
    sort(Endpoints0, Endpoints).

                /*******************************
                *         ONE PROCESS          *
                *******************************/

typhon_endpoint:requested(survey, look(Most), _, ReplyTo) :-
    scheduler_call(typhon_inventory:reply(Most, ReplyTo)).

:- public
    reply/2.                    % goal of a worker

reply(Most, ReplyTo) :-
    own_inventory(Most, Seen),
    endpoint_reply(ReplyTo, Seen).

own_inventory(0, seen(Hosts, [], 0)) :-
    !,
    findall(Host, host_seen(Host), Hosts).
own_inventory(Most, seen(Hosts, Agents, Count)) :-
    findall(Host, host_seen(Host), Hosts),
    findall(Id-Glance, agent_summary(Id, Glance), All0),
    sort(1, @<, All0, All),
    length(All, Count),
    maplist(agent_key, All, Keyed0),
    keysort(Keyed0, Keyed),
    pairs_values(Keyed, Sorted),
    findall(Agent, limit(Most, member(Agent, Sorted)), Agents).

agent_key(Id-Glance, Key-agent(Id, Glance)) :-
    inventory_order(Id, Key).

host_seen(host(Address, State, Load, Capacity, Arrived, Neighbours,
               Costs, Clock)) :-
    host_property(Name, address(Address)),
    findall(Property, host_property(Name, Property), Properties),
    option(state(State), Properties, stopped),
    option(load(Load), Properties, 0),
    option(capacity(Capacity), Properties, inf),
    option(neighbours(Neighbours), Properties, []),
    maplist(link_cost(Name), Neighbours, Costs),
    host_clock(Name, Clock),
    (   member(hop_time(in, stats(Arrived0, _, _, _)), Properties)
    ->  Arrived = Arrived0
    ;   Arrived = 0
    ).

host_clock(Name, Clock) :-
    (   time_kind(virtual)
    ->  Clock = virtual
    ;   clock(Name, Epoch, Rate),
        Clock = clock(Epoch, Rate)
    ).

%   The link may have been removed meanwhile.

link_cost(Name, Neighbour, Cost) :-
    (   host_link_cost(Name, Neighbour, Cost0)
    ->  Cost = Cost0
    ;   Cost = 1
    ).

                /*******************************
                *            RESULTS           *
                *******************************/

%!  inventory_hosts(+Places, +Seen, +Silent, -Hosts) is det.
%
%   Hosts are all hosts of an inventory.  They include hosts of silent processes
%   to which links lead; these have the state `gone` or `silent`.

inventory_hosts(Places, Seen, Silent, Hosts) :-
    findall(Host, ( member(seen(Some, _, _), Seen), member(Host, Some) ),
            Answered),
    findall(host(Address, State, '', '', '', [], [], none),
            unseen(Places, Seen, Silent, Address, State),
            Unseen0),
    sort(Unseen0, Unseen),
    append(Answered, Unseen, Hosts).

unseen(Places, Seen, Silent, Address, State) :-
    known_host(Places, Seen, Address),
    address_parts(Address, _, Endpoint),
    memberchk(Endpoint-Why, Silent),
    state_unseen(Why, State).

known_host(Places, _, Address) :-
    member(Address, Places).
known_host(_, _, Address) :-
    known(Address).
known_host(_, Seen, Address) :-
    member(Process, Seen),
    further_places(Process, Addresses),
    member(Address, Addresses).

state_unseen(gone, gone).
state_unseen(lost, silent).
state_unseen(late, silent).

%!  inventory_agents(+Seen, -Agents) is det.
%
%   Agents has each agent of an inventory once.  Two processes may report an
%   agent in transit; the entry with more hops is kept.

inventory_agents(Seen, Agents) :-
    findall(Some, member(seen(_, Some, _), Seen), Lists),
    append(Lists, All),
    map_list_to_pairs(hops_left, All, Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Sorted),
    sort(1, @<, Sorted, Agents).        % the first of each

hops_left(agent(_, glance(_, _, _, Hops, _)), Left) :-
    Left is -Hops.

%!  inventory_order(+Text, -Key) is det.
%
%   Key sorts texts with numbers in them by the values of the numbers: n2 before
%   n10.

inventory_order(Text, Key) :-
    atom_codes(Text, Codes),
    phrase(parts(Key), Codes).

parts([Text, Number|Parts]) -->
    string_without(`0123456789`, Codes),
    digits([Digit|Digits]),
    !,
    { atom_codes(Text, Codes),
      number_codes(Number, [Digit|Digits]) },
    parts(Parts).
parts([Text]) -->
    string_without(`0123456789`, Codes),
    { atom_codes(Text, Codes) }.

%   Longer lists and texts would not be readable.

most(tuples, 300).
most(clauses, 300).
longest(2000).

%!  host_report(+Host, -Report) is det.
%
%   Report is close_up(Properties, Options, Tuples, Clauses, Services): the
%   properties of Host as of host_property/2, and lists of strings.
%
%   @error existence_error(host, Host), host_unreachable(Host)

host_report(Host, Report) :-
    host_resolve(Host, Where),
    report_at(Where, Report).

report_at(local(Name), Report) :-
    own_report(Name, Report).
report_at(remote(Address, Name, Endpoint), Report) :-
    process_ask(Endpoint, Address, close_up, host(Name), Answer, 10),
    (   Answer == none
    ->  host_unknown(Address)
    ;   Report = Answer
    ).

typhon_endpoint:requested(close_up, host(Name), _Peer, ReplyTo) :-
    scheduler_call(typhon_inventory:report_reply(Name, ReplyTo)).

:- public
    report_reply/2.                            % goal of a worker

report_reply(Name, ReplyTo) :-
    (   host(Name, _, _)
    ->  own_report(Name, Answer)
    ;   Answer = none
    ),
    endpoint_reply(ReplyTo, Answer).

                /*******************************
                *         THIS PROCESS         *
                *******************************/

own_report(Name, close_up(Properties, Options, Tuples, Clauses, Services)) :-
    host(Name, _, Place),
    findall(P, ( host_property(Name, P), P \= place(_) ), Properties),
    findall(Text, ( host_option(Name, Option), text(Option, Text) ), Options),
    some(tuples, Text, tuple_text(Place, Text), Tuples),
    some(clauses, Text, clause_text(Place, Text), Clauses),
    findall(Text, ( service_text(Place, Text) ; offer_text(Name, Text) ),
            Services).

:- meta_predicate some(+, ?, 0, -).

some(What, Template, Goal, List) :-
    most(What, Most),
    findall(Template, limit(Most, Goal), List).

text(Term, Text) :-
    longest(Longest),
    abridged(Term, Longest, Text).

tuple_text(Place, Text) :-
    tuple_sense(Place, Fact),
    text(Fact, Text).

clause_text(Place, Text) :-
    own_predicate(Place, Head),
    catch(clause(Place:Head, Body), error(_, _), fail),
    clause_string((Head:-Body), Text).

clause_string(Clause, Text) :-
    with_output_to(string(Whole), print_clause(current_output, Clause, [])),
    longest(Longest),
    (   sub_string(Whole, 0, Longest, _, Begin)
    ->  string_concat(Begin, "...", Text)
    ;   Text = Whole
    ).

own_predicate(Place, Head) :-
    current_predicate(_, Place:Head),
    \+ predicate_property(Place:Head, imported_from(_)),
    functor(Head, Name, _),
    \+ sub_atom(Name, 0, _, _, $).

%   offer_text(+Name, -Text): Text describes a service that an agent offers on
%   the host.

offer_text(Name, Text) :-
    host_offers(Name, Offers),
    member(Agent-offer(Service, Properties), Offers),
    text(Service, ServiceText),
    text(Properties, PropertiesText),
    format(string(Text), '~s, by ~w: ~s', [ServiceText, Agent, PropertiesText]).

%   service_text(+Place, -Text): Text names a module, or a predicate of a
%   module, that is a service of the place.

service_text(Place, Text) :-
    import_module(Place, Module),
    Module \== typhon_vocabulary,
    format(string(Text), 'all of ~q', [Module]).
service_text(Place, Text) :-
    current_predicate(Name, Place:Head),
    predicate_property(Place:Head, imported_from(Module)),
    Module \== system,
    functor(Head, Name, Arity),
    format(string(Text), '~q', [Module:Name/Arity]).
