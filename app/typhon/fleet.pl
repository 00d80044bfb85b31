:- module(typhon_app_fleet,
          [ fleet/3                     % +What, +Arguments, +Options
          ]).
:- use_module(library(lists), [member/2, subset/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../prolog/typhon',
              [agent_where/2, fleet_parked/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/text', [format_shown/2]).
:- use_module('../../prolog/typhon/kernel/host',
              [address_parts/3, process_ask/6]).
:- use_module('../../prolog/typhon/options/fleet',
              [fleet_overview/3, fleet_park_drop/2, fleet_park_send/2]).
:- use_module('../../prolog/typhon/tools/tables', [print_table/3]).
:- use_module(engine_options, [in_fleet/4]).

/** <module> The command `fleet`

Questions about a whole fleet go to its engine.  What concerns one host goes to
its process, with the right of an administrator: the password of an engine
entitles to no orders.

*Threading*: the main thread.
*/

%!  fleet(+What, +Arguments, +Options) is semidet.
%
%   Fails if the answer is negative.

fleet(hosts, [], Options) =>
    in_fleet(fleet, Options, Fleet, fleet_overview(Fleet, [], Hosts)),
    findall(Row, ( member(Host, Hosts), wanted(Host, Options),
                   host_row(Host, Row) ),
            Rows),
    print_table([ host-left, state-left, since-left, agents-right,
                  parked-right, tags-left ], Rows, host).
fleet(where, [Agent], Options) =>
    in_fleet(fleet, Options, _, agent_where(Agent, Host)),
    format_shown('~w~n', [Host]).
fleet(park, [list], Options) =>
    in_fleet(fleet, Options, Fleet, fleet_parked(Fleet, Parked)),
    findall([Agent, Host, From, To],
            ( member(parked(Agent, Host, Since, Until), Parked),
              time_text(Since, From),
              time_text(Until, To) ),
            Rows),
    print_table([agent-left, host-left, since-left, until-left], Rows,
                'parked agent').
fleet(park, [drop, Agent], Options) =>
    in_fleet(fleet, Options, Fleet, fleet_park_drop(Fleet, Agent)).
fleet(park, [send, Agent], Options) =>
    in_fleet(fleet, Options, Fleet, fleet_park_send(Fleet, Agent)).
fleet(drain, [Host], Options) =>
    findall(Option, drain_option(Options, Option), DrainOptions),
    address_parts(Host, Name, _),
    asks(Host, typhon:fleet_drain(Name, [stay(Agents)|DrainOptions])),
    forall(member(Agent, Agents), format_shown('~w~n', [Agent])).
fleet(here, [Host], _) =>
    address_parts(Host, Name, _),
    asks(Host, typhon_fleets:fleet_here(Name)).
fleet(alive, [Host], Options) =>
    option(timeout(Seconds), Options, 10),
    address_parts(Host, Name, Endpoint),
    catch(process_ask(Endpoint, Host, remote, remote(Name, true), true(_),
                      Seconds),
          error(timeout_error(_, _), _),
          fail).
fleet(What, Arguments, _) =>
    Whats = [hosts, where, park, drain, here, alive],
    (   member(What, Whats)
    ->  throw(error(typhon_usage(arguments(fleet, [What|Arguments])), _))
    ;   throw(error(typhon_usage(unknown_command(What, Whats)), _))
    ).

%   asks(+Host, +Goal): an error with a compound part comes as raised_elsewhere.

asks(Host, Goal) :-
    catch(remote(Host, Goal),
          error(raised_elsewhere(error(resource_error(What), _)), _),
          lacks(What, Host)).

lacks(fleet(Fleet), Host) =>
    throw(error(typhon_usage(no_engine(Host, Fleet)), _)).
lacks(What, _) =>
    throw(error(resource_error(What), _)).

wanted(host(_, State, _, Tags, _, _), Options) :-
    (   option(away(true), Options)
    ->  State == away
    ;   true
    ),
    (   option(tag(Text), Options)
    ->  atomic_list_concat(Wanted, ',', Text),
        subset(Wanted, Tags)
    ;   true
    ).

host_row(host(Address, State, Load, Tags, Since, Parked),
         [Address, State, Time, Load, Parked, TagsText]) :-
    time_text(Since, Time),
    atomic_list_concat(Tags, ' ', TagsText).

time_text(Time, Text) :-
    (   number(Time)
    ->  format_time(atom(Text), '%F %T', Time)
    ;   Text = Time
    ).

drain_option(Options, to(Tags)) :-
    option(to(Text), Options),
    atomic_list_concat(Tags, ',', Text).
drain_option(Options, seconds(Seconds)) :-
    option(timeout(Seconds), Options).
