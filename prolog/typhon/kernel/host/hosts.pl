:- module(typhon_hosts,
          [ host/3,                     % ?Name, ?Address, ?Place
            host_add/4,                 % +Name, +Address, +Place, +Options
            host_close/1,               % +Name
            host_closed/1,              % +Name
            host_remove/1,              % +Name
            host_option/2,              % ?Name, ?Option
            host_put/2,                 % +Name, +Option
            host_note/1,                % +Name
            host_admits/2,              % +Name, +Tokens
            host_enter/3,               % +Name, +Tokens, -Answer
            host_again/1,               % +Name
            host_uncount/1,             % +Name
            host_load/2,                % +Name, -Load
            host_hop_times/3,           % +Name, ?Direction, -Times
            host_hop/4,                 % +Name, +Direction, +Since, -Seconds
            host_moved/4,               % +Here, +Name, +Since, -Seconds
            host_landing/4,             % +Name, -Address, -Place, -Landing
            host_arrival/2,             % +Landing, +Since
            host_plain_departure/2,     % +Name, -Since
            host_departure/2,           % +Name, +Since
            host_passage/6,             % +Here, +Host, ?Since, -Name-Address,
                                        % -Place0-Place, -Passage
            host_passes/2,              % +Passage, -Seconds
            host_neighbours/2,          % +Name, -Addresses
            host_link/3,                % +Name, +Address, +Cost
            host_unlink/2,              % ?Name, ?Address
            host_link_cost/3,           % +Name, +Address, -Cost
            host_resolve/2,             % +Host, -Where
            host_address/2,             % +Host, -Address
            address_parts/3             % ?Address, ?Name, ?Endpoint
          ]).

/** <module> Hosts of this process, their links, and names of hosts

The record of a host: name, address, place, options, and their counts: the
number of agents on them, their load, and how long hops into and out of them
take, in host seconds.

A link is recorded in one direction; the other host records the other.

host_resolve/2 maps the name or address that a caller gives to the location of
the host. A bare name is looked up first in this process, and then in the other
processes of the networks that this process started. For any(Tags) an option
chooses a host, by the hook one_of/2.

*Threading*: any thread; a mutex for changes of links.  The counts are flags,
which many threads change without leaving garbage, under one mutex: flag/3
would lock for each of them.
*/

:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [existence_error/2, is_of_type/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/bounds', [memory_short/1]).
:- use_module('../base/durable',
              [durable/6, durable_drop/3, durable_on/0, durable_put/4]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/text', [is_printable/1]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_parts/3, must_be_endpoint/1]).
:- use_module(events, [event/4]).
:- use_module(host_parts, [parts/3, parts_compile/1, parts_forget/1]).
:- use_module(time, [clock/3, host_time/2, time_flag/1, time_now/1]).

:- dynamic
    host/3,                             % Name, Address, Place
    host_option/2,                      % Name, Option
    admits/4,                           % Name, Tokens, Capacity, Flag: while
                                        % it admits agents
    counts/4,                           % Name, Load, In, Out: a flag, and twice
                                        % flags(Count, Min, Sum, Max) of hops
    host_plain/3,                       % Name, or its address, Name, Plain
    neighbour/2,                        % Name, Address
    cost/3.                             % Name, Address, Cost: of a link, if not 1

:- multifile
    elsewhere/2,                        % ?Name, -Address: a host of a network that
                                        % this process started
    one_of/2,                           % Description, Address: choose a host
    typhon_names:known/2,
    prolog:error_message//1,
    error:has_type/2.

:- set_prolog_flag(optimise, true).     % arithmetic without calls

%!  host(?Name, ?Address, ?Place) is nondet.
%
%   The hosts of this process, in the order of their start.

%!  host_add(+Name, +Address, +Place, +Options) is det.
%
%   Add a host, which admits agents from now on.

host_add(Name, Address, Place, Options) :-
    make_flags(Name),
    forall(member(Option, Options), assertz(host_option(Name, Option))),
    parts_compile(Name),
    assertz(host(Name, Address, Place)),
    begin_admitting(Name),
    note_plain(Name),
    host_note(Name).

begin_admitting(Name) :-
    asked(Name, tokens(Tokens), []),
    asked(Name, capacity(Capacity), inf),
    counts(Name, Load, _, _),
    assertz(admits(Name, Tokens, Capacity, Load)).

%   host_plain(+Host, ?Name, -Plain): Host is Name or its address.  The host
%   admits agents, has no parts, and asks for no token, so the kernel alone
%   handles its hops.  Plain is all that a hop needs of it.

note_plain(Name) :-
    (   \+ parts(_, Name, _),
        admits(Name, [], Capacity, Load),
        host(Name, Address, Place),
        asked(Name, hop_time(Delay), none),
        clock(Name, Epoch, Rate),
        counts(Name, _, In, Out)
    ->  Plain = plain(Address, Place, Delay, Epoch, Rate, Capacity, Load, In,
                      Out),
        assertz(host_plain(Name, Name, Plain)),
        assertz(host_plain(Address, Name, Plain))
    ;   true
    ).

no_longer_plain(Name) :-
    forall(( Host = Name ; host(Name, Host, _) ),
           retractall(host_plain(Host, _, _))).

%!  host_plain_departure(+Name, -Since:float) is semidet.
%
%   A hop from Name to another process begins now, at Since.  Fails if Name is
%   not plain, or delays hops.

host_plain_departure(Name, Since) :-
    host_plain(Name, _, plain(_, _, none, Epoch, Rate, _, _, _, _)),
    !,
    monotonic_time(Now),
    Since is (Now-Epoch)*Rate.

%!  host_passage(+Here, +Host, ?Since, -There, -Places, -Passage) is semidet.
%
%   A hop from Here to Host, another host of this process, which began at Since,
%   or begins now; host_passes/2 counts it.  There is Name-Address of Host, and
%   Places are those of both.  Fails if a host is not plain, or Here delays a hop
%   that begins now.

host_passage(Here, Host, Since, Name-Address, Place0-Place,
             passage(Here, From, Name, To, Since)) :-
    host_plain(Here, _, From),
    From = plain(_, Place0, Delay, Epoch, Rate, _, _, _, _),
    ( nonvar(Since) -> true ; Delay == none ),
    atom(Host),
    host_plain(Host, Name, To),
    Name \== Here,
    To = plain(Address, Place, _, _, _, _, _, _, _),
    (   nonvar(Since)
    ->  true
    ;   time_flag(_)                    % no time passes
    ->  Since = now
    ;   monotonic_time(Now),
        Since is (Now-Epoch)*Rate
    ).

asked(Name, Option, Default) :-
    (   host_option(Name, Option)
    ->  true
    ;   arg(1, Option, Default)
    ).

make_flags(Name) :-
    make_flag(load, Name, 0, Load),
    make_hop_flags(in, Name, In),
    make_hop_flags(out, Name, Out),
    assertz(counts(Name, Load, In, Out)).

make_hop_flags(Direction, Name, flags(Count, Min, Sum, Max)) :-
    make_flag(Direction-count, Name, 0, Count),
    make_flag(Direction-min, Name, inf, Min),
    make_flag(Direction-sum, Name, 0.0, Sum),
    make_flag(Direction-max, Name, 0.0, Max).

make_flag(What, Name, Value0, Flag) :-
    format(atom(Flag), 'typhon ~w ~w', [What, Name]),
    flag(Flag, _, Value0).

:- durable(counts, Name, 0, Values, counts_item(Name, Values),
           counts_restore(Name, Values)).

counts_item(Name, Values) :-
    host(Name, _, _),
    flags_of(Name, Flags),
    maplist(get_flag, Flags, Values).

counts_restore(Name, Values) :-
    flags_of(Name, Flags),
    maplist(set_flag, Flags, Values).

flags_of(Name, [Load|Flags]) :-
    counts(Name, Load, In, Out),
    findall(Flag, ( arg(_, In, Flag) ; arg(_, Out, Flag) ), Flags).

%!  host_close(+Name) is det.
%
%   Stop admitting agents to Name, which is about to stop.

host_close(Name) :-
    no_longer_plain(Name),
    retractall(admits(Name, _, _, _)).

%!  host_closed(+Name) is semidet.
%
%   Name admits no agents.

host_closed(Name) :-
    \+ admits(Name, _, _, _).

%!  host_remove(+Name) is det.
%
%   Remove the records of Name, which has stopped.

host_remove(Name) :-
    durable_drop(host, Name, 0),
    host_close(Name),
    retractall(host(Name, _, _)),
    retractall(host_option(Name, _)),
    host_unlink(Name, _),
    retractall(counts(Name, _, _, _)),
    parts_forget(Name).

%!  host_option(?Name, ?Option) is nondet.
%
%   Name has Option, as in host_start/2.

%!  host_note(+Name) is det.
%
%   Make the present options of Name durable. host_add/4 and host_put/2 do so,
%   too, if changes are queued already.

host_note(Name) :-
    (   durable_on
    ->  findall(Option,
                ( host_option(Name, Option),
                  \+ typhon_host_parts:unnoted(Option) ),
                Options),
        durable_put(host, Name, 0, Options)
    ;   true
    ).

%!  host_put(+Name, +Option) is det.
%
%   Replace the option of the same name.  The new one is added before the old
%   one is removed, so readers always find one.  The host is not plain until
%   its parts are those of the new options.

host_put(Name, Option) :-
    functor(Option, OptionName, Arity),
    functor(Old, OptionName, Arity),
    no_longer_plain(Name),
    (   host_option(Name, Old)
    ->  assertz(host_option(Name, Option)),
        once(retract(host_option(Name, Old)))
    ;   assertz(host_option(Name, Option))
    ),
    parts_compile(Name),
    (   admits(Name, Tokens, Capacity, Key)
    ->  begin_admitting(Name),
        once(retract(admits(Name, Tokens, Capacity, Key)))
    ;   true                            % the host is stopping
    ),
    note_plain(Name),
    host_note(Name).

                /*******************************
                *          ADMISSION           *
                *******************************/

%!  host_admits(+Name, +Tokens) is semidet.
%
%   host_enter/3 would answer `ok` now.

host_admits(Name, Tokens) :-
    admits(Name, Wanted, Capacity, Load),
    ( Wanted == [] -> true ; has_token(Wanted, Tokens) ),
    get_flag(Load, Count),
    Count < Capacity.

%!  host_enter(+Name, +Tokens, -Answer) is det.
%
%   Admit an agent with Tokens.  Answer is `ok`, and the agent counts in the
%   load, or refused(Reason).

host_enter(Name, Tokens, Answer) :-
    (   admits(Name, Wanted, Capacity, Load)
    ->  (   Wanted \== [],
            \+ has_token(Wanted, Tokens)
        ->  Answer = refused(token)
        ;   with_mutex(typhon_host_flags, count_entry(Capacity, Load, Answer))
        )
    ;   Answer = refused(unknown_host)
    ).

has_token(Wanted, Tokens) :-
    member(Token, Wanted),
    member(Shown, Tokens),
    subsumes_term(Token, Shown),        % an unbound token does not match
    !.

count_entry(Capacity, Key, ok) :-
    get_flag(Key, Load),
    Load < Capacity,
    !,
    count(Key, 1).
count_entry(_, _, refused(capacity)).

count(Flag, Change) :-
    get_flag(Flag, Count0),
    Count is Count0+Change,
    set_flag(Flag, Count).

%!  host_landing(+Name, -Address, -Place, -Landing) is semidet.
%!  host_arrival(+Landing, +Since) is semidet.
%
%   Name, which is plain, can take an agent from another process.
%   host_arrival/2 counts one that arrives by a hop that began at Since, in host
%   time.  It fails and counts nothing if the host is full or no longer plain.

host_landing(Name, Address, Place, landing(Name, Plain)) :-
    host_plain(Name, Name, Plain),      % its name, and not its address
    Plain = plain(Address, Place, _, _, _, _, _, _, _).

host_arrival(landing(Name, Plain), Since) :-
    Plain = plain(_, _, _, Epoch, Rate, _, _, _, _),
    monotonic_time(Now),
    Seconds is max(0.0, (Now-Epoch)*Rate-Since),
    with_mutex(typhon_host_flags, came(Name, Plain, Seconds)).

%!  host_again(+Name) is det.
%
%   Count an agent on Name in its load again, even beyond its capacity.

host_again(Name) :-
    load_changes(Name, 1).

%!  host_uncount(+Name) is det.
%
%   Stop counting an agent in the load of Name.

host_uncount(Name) :-
    load_changes(Name, -1).

load_changes(Name, Change) :-
    (   counts(Name, Load, _, _)
    ->  with_mutex(typhon_host_flags, count(Load, Change))
    ;   true                            % stopped meanwhile
    ).

%!  host_load(+Name, -Load:integer) is det.
%
%   Load agents are on Name, faulty ones not counted.

host_load(Name, Load) :-
    counts(Name, Flag, _, _),
    get_flag(Flag, Load).

                /*******************************
                *             HOPS             *
                *******************************/

%!  host_departure(+Name, +Since) is det.
%
%   Count an agent that has left Name for another process, by a hop that began
%   at Since.

host_departure(Name, Since) :-
    host_plain(Name, _, plain(_, _, _, Epoch, Rate, _, Load, _, Out)),
    !,
    monotonic_time(Now),
    Seconds is max(0.0, (Now-Epoch)*Rate-Since),
    with_mutex(typhon_host_flags, left(Load, Out, Seconds)).
host_departure(Name, Since) :-
    ignore(host_hop(Name, out, Since, _)),
    host_uncount(Name).

%!  host_moved(+Here, +Name, +Since, -Seconds:float) is det.
%
%   Count a hop within this process, of an agent that is counted on Name already.
%   A host may have been stopped meanwhile; one that stops waits for the last step.

host_moved(Here, Name, Since, Seconds) :-
    (   ( host_time(Here, Now) ; host_time(Name, Now) )
    ->  Seconds is max(0.0, Now-Since)
    ;   Seconds = 0.0
    ),
    ignore(hop_count(Here, out, Seconds)),
    ignore(hop_count(Name, in, Seconds)),
    host_uncount(Here).

%!  host_passes(+Passage, -Seconds:float) is semidet.
%
%   Count the hop of host_passage/6, which took Seconds.  Fails if the other host
%   is full, or one of them is no longer plain.

host_passes(passage(Here, From, Name, To, Since), Seconds) :-
    host_plain(Here, _, From),          % it still is
    (   Since == now
    ->  Seconds = 0.0
    ;   From = plain(_, _, _, Epoch, Rate, _, _, _, _),
        time_now(Now),
        Seconds is max(0.0, (Now-Epoch)*Rate-Since)
    ),
    with_mutex(typhon_host_flags, passes(From, Name, To, Seconds)).

passes(plain(_, _, _, _, _, _, Load0, _, Out), Name, To, Seconds) :-
    To = plain(_, _, _, _, _, _, Load, In, _),
    get_flag(Load, Count),
    place_taken(Name, To, Count),
    left(Load0, Out, Seconds),
    hop_time_add(In, Seconds).

%   place_taken(+Name, +Plain, +Count): the load of Name, which is Count, grows
%   by one.  A host that stops is first no longer plain, and then waits until its
%   load is 0.  So if it is still plain after its load has grown, the stop waits
%   for the agent.

place_taken(Name, Plain, Count) :-
    Plain = plain(_, _, _, _, _, Capacity, Load, _, _),
    Count < Capacity,
    Count1 is Count+1,
    set_flag(Load, Count1),
    (   host_plain(Name, _, Plain)
    ->  true
    ;   set_flag(Load, Count),
        fail
    ).

came(Name, Plain, Seconds) :-
    Plain = plain(_, _, _, _, _, _, Load, In, _),
    get_flag(Load, Count),
    Next is Count+1,
    \+ memory_short(Next),
    place_taken(Name, Plain, Count),
    hop_time_add(In, Seconds).

left(Load, Out, Seconds) :-
    get_flag(Load, Count0), Count is Count0-1, set_flag(Load, Count),
    hop_time_add(Out, Seconds).

%!  host_hop(+Name, +Direction, +Since, -Seconds:float) is semidet.
%
%   Record a hop `in` or `out`.  Fails if Name was stopped meanwhile.

host_hop(Name, Direction, Since, Seconds) :-
    host_time(Name, Now),
    Seconds is max(0.0, Now-Since),
    hop_count(Name, Direction, Seconds).

hop_count(Name, Direction, Seconds) :-
    counts(Name, _, In, Out),
    hop_flags(Direction, In, Out, Flags),
    with_mutex(typhon_host_flags, hop_time_add(Flags, Seconds)).

hop_flags(in, In, _, In).
hop_flags(out, _, Out, Out).

%   hop_time_add(+Flags, +Seconds): inside the mutex.  In virtual time most hops
%   take no time.

hop_time_add(flags(Count, Min, Sum, Max), Seconds) :-
    get_flag(Count, N0), N is N0+1, set_flag(Count, N),
    (   Seconds =:= 0.0,
        get_flag(Min, 0.0)
    ->  true
    ;   get_flag(Sum, Sum0), Sum1 is Sum0+Seconds, set_flag(Sum, Sum1),
        get_flag(Min, Min0),
        ( Seconds < Min0 -> set_flag(Min, Seconds) ; true ),
        get_flag(Max, Max0),
        ( Seconds > Max0 -> set_flag(Max, Seconds) ; true )
    ).

%!  host_hop_times(+Name, ?Direction, -Times) is nondet.
%
%   Times is stats(Count, Min, Mean, Max) of the hops in that Direction.

host_hop_times(Name, Direction, stats(Count, Min, Mean, Max)) :-
    counts(Name, _, In, Out),
    hop_flags(Direction, In, Out,
              flags(CountFlag, MinFlag, SumFlag, MaxFlag)),
    get_flag(CountFlag, Count),
    get_flag(MaxFlag, Max),
    (   Count =:= 0
    ->  Min = 0.0, Mean = 0.0
    ;   get_flag(MinFlag, Min),
        get_flag(SumFlag, Sum),
        Mean is Sum/Count
    ).

                /*******************************
                *            LINKS             *
                *******************************/

%!  host_link(+Name, +Address, +Cost) is det.
%
%   Make one direction of a link; does nothing if it exists.  Cost is a number,
%   or `same`: the present cost, 1 for a new link.  Listeners get changes in
%   the order in which they were made.

host_link(Name, Address, Cost) :-
    with_mutex(typhon_links,
               ( link(Name, Address, Cost, Was),
                 (   Was == new
                 ->  event(links, Name, none, link(Address))
                 ;   true
                 ) )).

link(Name, Address, Cost, Was) :-
    (   neighbour(Name, Address)
    ->  Was = known
    ;   Was = new,
        assertz(neighbour(Name, Address))
    ),
    set_cost(Cost, Name, Address),
    link_item(Key, Name, Address, Now),
    durable_put(link, Key, 0, link(Name, Address, Now)).

:- durable(link, Key, 0, link(Name, Address, Cost),
           link_item(Key, Name, Address, Cost),
           link_restore(Name, Address, Cost)).

link_item(Key, Name, Address, Cost) :-
    neighbour(Name, Address),
    host_link_cost(Name, Address, Cost),
    link_key(Name, Address, Key).

link_key(Name, Address, Key) :-
    atomic_list_concat([Name, Address], ' ', Key).

%   This reports no event, because the link existed before.

link_restore(Name, Address, Cost) :-
    with_mutex(typhon_links, link(Name, Address, Cost, _)).

%   A concurrent caller finds the old cost or the new one.

set_cost(same, _, _) :-
    !.
set_cost(Cost, Name, Address) :-
    cost(Name, Address, _),
    !,
    assertz(cost(Name, Address, Cost)),
    once(retract(cost(Name, Address, _))).
set_cost(Cost, Name, Address) :-
    assertz(cost(Name, Address, Cost)).

%!  host_unlink(?Name, ?Address) is det.
%
%   Remove one direction of links; does nothing if there is none.

host_unlink(Name, Address) :-
    with_mutex(typhon_links, unlink(Name, Address)).

unlink(Name, Address) :-
    findall(Name-Address, neighbour(Name, Address), Links),
    forall(( member(From-To, Links), link_key(From, To, Key) ),
           durable_drop(link, Key, 0)),
    retractall(neighbour(Name, Address)),
    retractall(cost(Name, Address, _)),
    forall(member(From-To, Links), event(links, From, none, unlink(To))).

%!  host_link_cost(+Name, +Address, -Cost) is semidet.
%
%   Fails if there is no such link.

host_link_cost(Name, Address, Cost) :-
    neighbour(Name, Address),
    !,
    (   cost(Name, Address, Cost0)
    ->  Cost = Cost0
    ;   Cost = 1
    ).

%!  host_neighbours(+Name, -Addresses:list(atom)) is det.

host_neighbours(Name, Addresses) :-
    findall(Address, neighbour(Name, Address), Addresses0),
    once_each(Addresses0, Addresses).

%   While other threads make links, 9.0.4 may return one twice in a row.

once_each([A,B|Rest], Set) :-
    A == B,
    !,
    once_each([B|Rest], Set).
once_each([A|Rest], [A|Set]) :-
    once_each(Rest, Set).
once_each([], []).

                /*******************************
                *            NAMES             *
                *******************************/

%   Completion proposes the hosts of other processes by their addresses.

typhon_names:known(host, Name) :-
    host(Name, _, _).
typhon_names:known(host, Address) :-
    neighbour(_, Address),
    \+ host(_, Address, _).

%!  address_parts(?Address, ?Name, ?Endpoint) is semidet.
%
%   Address is Name@Endpoint, where Endpoint is 'Interface:Port'.

address_parts(Address, Name, Endpoint) :-
    atom(Address),
    !,
    atomic_list_concat([Name,Endpoint], '@', Address),
    Name \== '',
    Endpoint \== ''.
address_parts(Address, Name, Endpoint) :-
    atomic_list_concat([Name,Endpoint], '@', Address).

error:has_type(host_address, Address) :-
    atom(Address),
    is_address(Address, _, Endpoint),
    endpoint_parts(Endpoint, _, _).

prolog:error_message(type_error(host_address, Address)) -->
    [ '~p is no address NAME@INTERFACE:PORT, with a name or an IPv4 \c
       address (IPv6 addresses are not supported)'-[Address] ].

is_address(Address, Name, Endpoint) :-
    address_parts(Address, Name, Endpoint),
    sub_atom(Endpoint, _, _, _, :),
    is_printable(Address),
    !.

%!  host_resolve(+Host, -Where) is det.
%
%   Where is local(Name) or remote(Address, Name, Endpoint).  Host is an
%   address, the name of a host of this process, a name that only one host
%   of the networks that this process started has, or any(Tags), Tags a tag or
%   a list of tags.  Each call for any(Tags) may choose another host.
%
%   @error existence_error(host, Host)
%   @error errors of one_of/2
%   @error domain_error(endpoint_address, Endpoint) of an address
%   @error ambiguous_host(Name, Addresses)

host_resolve(Host, Where) :-
    \+ atom(Host),
    !,
    described(Host, Address),
    host_resolve(Address, Where).
host_resolve(Host, local(Host)) :-
    host(Host, _, _),
    !.
host_resolve(Host, local(Name)) :-
    host(Name, Host, _),
    !.
host_resolve(Host, remote(Host, Name, Endpoint)) :-
    is_address(Host, Name, Endpoint),
    !,
    must_be_endpoint(Endpoint).
host_resolve(Name, remote(Address, Name, Endpoint)) :-
    findall(Found, in_other_process(Name, Found), Found0),
    sort(Found0, Addresses),
    the_only(Addresses, Name, Address),
    address_parts(Address, _, Endpoint).

described(Host, Address) :-
    is_of_type(host_description, Host),
    on_demand_load(description, any),
    one_of(Host, Address0),
    !,
    must_be(atom, Address0),
    Address = Address0.
described(Host, _) :-
    is_of_type(host_description, Host),
    !,
    throw(error(existence_error(host, Host),
                context(_, 'nothing in this process knows hosts by tags'))).
described(Host, _) :-
    must_be(atom, Host).

error:has_type(host_description, any(Tags)) :-
    (   is_list(Tags)
    ->  Tags = [_|_],
        maplist(atom, Tags)
    ;   atom(Tags)
    ).

%   elsewhere/2 may still list a host of this process that is stopping.

in_other_process(Name, Address) :-
    elsewhere(Name, Address),
    address_parts(Address, _, Endpoint),
    \+ endpoint_address(Endpoint).

the_only([Address], _, Address) :-
    !.
the_only([], Name, _) :-
    existence_error(host, Name).
the_only([Address|Addresses], Name, _) :-
    throw(error(ambiguous_host(Name, [Address|Addresses]), _)).

%!  host_address(+Host, -Address) is det.
%
%   The address of Host, as in host_resolve/2.

host_address(Host, Address) :-
    host_resolve(Host, Where),
    (   Where = local(Name)
    ->  host(Name, Address, _)
    ;   arg(1, Where, Address)
    ).
