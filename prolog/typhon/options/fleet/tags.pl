:- module(typhon_fleet_tags,
          [ hosts_of_fleet/3,           % +Fleet, -Hosts, +Options
            choices_forget/1            % +Fleet
          ]).
:- use_module(library(error), [existence_error/2, must_be/2, resource_error/1]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/host',
              [ address_parts/3, host/3, host_address/2, host_neighbours/2 ]).
:- use_module(engine, [engine_script/4]).
:- use_module(members, [fleet_joined/2, must_be_fleet/1]).

/** <module> Hosts of a fleet, by their tags

*Threading*: any thread that may wait.
*/

:- multifile
    typhon_hosts:one_of/2,
    typhon_members:is_new/1,
    typhon_names:known/2,
    typhon_options:declared/4.

:- setting(typhon_fleet:choice_seconds, number, 0.5,
           "Seconds for which a list of hosts serves for choices by any(Tag)").

:- dynamic
    choice/4,                   % Fleet, Tags, Until, Loads: Load-Host
    seen/2.                     % Fleet, Tag: for proposals

typhon_names:known(tag, Tag) :-
    seen(_, Tag).

%!  hosts_of_fleet(+Fleet, -Hosts:list, +Options) is det.
%
%   See fleet_hosts/3.

hosts_of_fleet(Fleet, Hosts, Options) :-
    check_options(fleet_hosts_option, Options),
    option(tag(Tag), Options, []),
    tags(Tag, Tags),
    must_be_fleet(Fleet),
    known(Fleet, Tags, Known),
    findall(Rank-Host,
            ( member(host(Host, Load, State), Known),
              wanted(Options, State),
              rank(Options, Host, Load, Rank) ),
            Ranked),
    keysort(Ranked, Sorted),
    pairs_values(Sorted, Hosts).

typhon_options:declared(fleet_hosts_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(tag(X), atom, X).
option_type(tag(X), list(atom), X).
option_type(state(X), oneof([up, away]), X).
option_type(near(X), atom, X).

tags([], []) :-
    !.
tags(Tags, Tags) :-
    is_list(Tags),
    !,
    must_be(list(atom), Tags).
tags(Tag, [Tag]) :-
    must_be(atom, Tag).

wanted(Options, State) :-
    (   option(state(Wanted), Options)
    ->  State == Wanted
    ;   true
    ).

rank(Options, Host, Load, rank(Distance, Load)) :-
    (   option(near(Near), Options)
    ->  host_address(Near, Address),
        distance(Address, Host, Distance)
    ;   Distance = 0
    ).

distance(Address, Address, 0) :-
    !.
distance(Address, Host, 1) :-
    address_parts(Address, Name, _),
    host(Name, Address, _),
    host_neighbours(Name, Neighbours),
    memberchk(Host, Neighbours),
    !.
distance(Address, Host, 2) :-
    machine(Address, Machine),
    machine(Host, Machine),
    !.
distance(_, _, 3).

machine(Address, Machine) :-
    address_parts(Address, _, Endpoint),
    atomic_list_concat([Machine,_], :, Endpoint).

%   known(+Fleet, +Tags, -Hosts): of each host(Address, Load, State).

known(Fleet, Tags, Hosts) :-
    engine_script(Fleet, hosts, Tags, Rows),
    (   Rows = ["unknown",Tag,Tags0]
    ->  no_tag(Fleet, Tag, Tags0)
    ;   findall(host(Host, Load, State),
                ( member([Host0,Load0,State0], Rows),
                  atom_string(Host, Host0),
                  number_string(Load, Load0),
                  atom_string(State, State0) ),
                Hosts)
    ).

no_tag(Fleet, Tag0, Tags0) :-
    retractall(seen(Fleet, _)),
    forall(member(Text, Tags0),
           ( atom_string(Known, Text), assertz(seen(Fleet, Known)) )),
    atom_string(Tag, Tag0),
    existence_error(tag, Tag).

                /*******************************
                *            CHOICES           *
                *******************************/

%   A list of hosts serves for half a second, in which own choices count: many
%   agents that choose at once spread over the hosts.

typhon_hosts:one_of(any(Tag), Host) :-
    tags(Tag, Tags),
    findall(Fleet, fleet_joined(Fleet, _), Fleets),
    (   Fleets == []
    ->  existence_error(fleet, any(Tag))
    ;   one_of_fleets(Fleets, Tags, none, Answer),
        chosen_or_error(Answer, Tag, Host)
    ).

%   one_of_fleets(+Fleets, +Tags, +Error0, -Answer): Answer is host(Host) of the
%   first fleet that has one, else the first error, or `none`.

one_of_fleets([], _, Answer, Answer).
one_of_fleets([Fleet|Fleets], Tags, Error0, Answer) :-
    catch(one_in(Fleet, Tags, Answer0), error(Formal, Context),
          Answer0 = error(Formal, Context)),
    (   Answer0 = host(_)
    ->  Answer = Answer0
    ;   ( Error0 == none -> Error = Answer0 ; Error = Error0 ),
        one_of_fleets(Fleets, Tags, Error, Answer)
    ).

one_in(Fleet, Tags, Answer) :-
    loads(Fleet, Tags, Until, Loads),
    (   with_mutex(typhon_fleet_choice,
                   chosen(Fleet, Tags, Until, Loads, Host))
    ->  Answer = host(Host)
    ;   Answer = none
    ).

chosen_or_error(host(Host), _, Host).
chosen_or_error(none, Tag, _) :-
    resource_error(hosts(Tag)).
chosen_or_error(error(Formal, Context), _, _) :-
    throw(error(Formal, Context)).

%!  choices_forget(+Fleet) is det.
%
%   The next choice asks the engine.

choices_forget(Fleet) :-
    retractall(choice(Fleet, _, _, _)).

typhon_members:is_new(Fleet) :-
    choices_forget(Fleet).

%   loads(+Fleet, +Tags, -Until, -Loads): asked without a lock.

loads(Fleet, Tags, Until, Loads) :-
    choice(Fleet, Tags, Until, Loads),
    monotonic_time(Now),
    Now < Until,
    !.
loads(Fleet, Tags, Until, Loads) :-
    known(Fleet, Tags, Hosts),
    findall(Load-Host, member(host(Host, Load, up), Hosts), Loads),
    setting(typhon_fleet:choice_seconds, Seconds),
    deadline(Seconds, Until).

chosen(Fleet, Tags, Until, Loads0, Host) :-
    (   choice(Fleet, Tags, Until, Loads1)
    ->  true
    ;   Loads1 = Loads0
    ),
    msort(Loads1, [Least-Host|Others]),
    More is Least+1,
    retractall(choice(Fleet, Tags, _, _)),
    assertz(choice(Fleet, Tags, Until, [More-Host|Others])).
