:- module(typhon_lasting,
          [ lasting_open/3,             % +Plan, +P, +Machines
            lasting_back/2,             % +Plan, +Log
            lasting_child/4,            % +Plan, ?Log, +P, -Options
            lasting_goes_on/3,          % +Network, +P, +Plan
            lasting_restarts/4,         % +Network, +P, +Plan, +Common
            lasting_rests/1,            % +Plan
            lasting_over/1              % +Plan
          ]).
:- use_module('../kernel/host', [host/3, hosts_back/1, hosts_journal/2, hosts_rest/0]).
:- use_module('../options/journal', [journal_opened/1, journal_place/2]).
:- use_module(carriers, [carrier_order/4]).
:- use_module(kept, [kept_end/1]).
:- use_module(plan,
              [ plan_furnishing/2, plan_hosts/4, plan_journal/4, plan_links/2,
                plan_option/2, plan_processes/3, plan_shape/3 ]).
:- use_module(processes, [carriers_restart/3]).
:- use_module(wiring, [wire_again/5, wire_go_on/2]).

/** <module> Networks that outlive their processes

Each process of a network with a journal has one of its own: this process, if
it carries the hosts, or its children.  What is there is there again before
anything of it goes on: then all find each other.

*Threading*: the thread that starts or stops the network, and that of module
`restarts`.
*/

%!  lasting_open(+Plan, +P, +Machines) is det.
%!  lasting_back(+Plan, +Log) is det.
%
%   If this process carries the network of Plan, and that has a journal: it is
%   open; what it knows is there again, its hosts with the option Log.  In
%   between the process begins to listen, which it must not have done before.
%
%   @error as hosts_journal/2

lasting_open(Plan, 1, [local]) :-
    plan_journal(Plan, 1, Where, How),
    !,
    hosts_journal(Where, [sync(How)]).
lasting_open(_, _, _).

lasting_back(Plan, Log) :-
    (   own(Plan)
    ->  hosts_back(Log)
    ;   true
    ).

own(Plan) :-
    plan_processes(Plan, 1, [local]),
    plan_journal(Plan, 1, Where, _),
    journal_place(Where, Place),
    journal_opened(Place).

%!  lasting_child(+Plan, ?Log, +P, -Options) is det.
%
%   Options of the child that carries part P, see child_start/6.  Hosts that
%   its journal knows have another Log from now on, if that is a list.

lasting_child(Plan, Log, P, Options) :-
    (   plan_journal(Plan, P, Where, How)
    ->  Options = [journal(Where, How)|More],
        ( is_list(Log) -> More = [hosts(Log)] ; More = [] )
    ;   Options = []
    ).

%!  lasting_goes_on(+Network, +P, +Plan) is det.
%
%   All is there.

lasting_goes_on(Network, P, Plan) :-
    (   plan_option(Plan, journal(_))
    ->  wire_go_on(Network, P)
    ;   true
    ).

%!  lasting_restarts(+Network, +P, +Plan, +Common) is det.
%
%   Children that die are started again, if the plan says so.  Their hosts are
%   what their journals know, or else what they were at the beginning.

lasting_restarts(Network, P, Plan, Common) :-
    (   plan_option(Plan, restart(true))
    ->  carriers_restart(Network,
                         lasting_child(Plan, none),
                         again(Network, Plan, P, Common))
    ;   true
    ).

again(Network, Plan, Count, Common, P) :-
    plan_hosts(Plan, Count, Common, Hosts),
    (   plan_option(Plan, journal(_))
    ->  wire_again(Network, P, Hosts, [], []),
        carrier_order(Network, P, go_on, ok)
    ;   plan_links(Plan, Links),
        plan_furnishing(Plan, Goals),
        wire_again(Network, P, Hosts, Links, Goals)
    ).

%!  lasting_rests(+Plan) is semidet.
%!  lasting_over(+Plan) is det.
%
%   The hosts of this process stop, and what is in its journal rests there.
%   Fails if that is not the journal of this network, or other hosts are here:
%   then those of the network end for good, as any do, and nothing is kept of
%   it.

lasting_rests(Plan) :-
    own(Plan),
    plan_shape(Plan, Names, _),
    \+ ( host(Other, _, _), \+ memberchk(Other, Names) ),
    hosts_rest.

lasting_over(Plan) :-
    (   own(Plan)
    ->  kept_end(Plan)
    ;   true
    ).
