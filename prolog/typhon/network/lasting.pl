:- module(typhon_lasting,
          [ lasting_open/3,             % +Plan, +P, +Machines
            lasting_back/2,             % +Plan, +Log
            lasting_child/4,            % +Plan, ?Log, +P, -Options
            lasting_goes_on/3,          % +Network, +P, +Plan
            lasting_restarts/4,         % +Network, +P, +Plan, +Common
            lasting_rests/1,            % +Plan
            lasting_over/1,             % +Plan
            kept_plan/4,                % +Topology, +Options, -Plan, -Kept
            kept_note/3                 % +Plan, +Clock, +How
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../kernel/base/durable', [durable_opened/1]).
:- use_module('../kernel/base/names', [counted/3]).
:- use_module('../kernel/base/options', [check_options/2]).
:- use_module('../kernel/host', [host/3, hosts_rest/0]).
:- use_module('../options/journal',
              [ hosts_back/1, hosts_journal/2, journal_place/2,
                journal_record/2, journal_record_drop/1,
                journal_record_put/2 ]).
:- use_module(nodes, [node_order/4]).
:- use_module(plan,
              [ network_plan/3, plan_host_setup/2, plan_hosts/4,
                plan_joins/2, plan_journal/4, plan_links/2, plan_option/2,
                plan_options/2, plan_processes/3, plan_shape/3, plan_without/3 ]).
:- use_module(processes, [nodes_restart/3]).
:- use_module(wiring, [wire_again/5, wire_go_on/2]).

/** <module> Networks that outlive their processes

Each process that runs hosts of a network with a journal has a journal of its
own: this process, or each of its children.  All journals are restored
before any agent resumes, so that agents and hosts find each other.

Besides these journals a record holds the text of one term,

    network(Version, How, Plan, Clock)

How is `begun`, or `built` when the whole plan has been carried out.  A network
that is started again must be the same.  Options that are not given keep their
values.  Options with other values raise an error, unless they may change.

*Threading*: the thread that starts or stops the network, and that of module
`restarts`.
*/

%!  lasting_open(+Plan, +P, +Machines) is det.
%
%   Open the journal of Plan, if it has one and this process runs its hosts.
%   The endpoint of the process must start after this.
%
%   @error as hosts_journal/2

lasting_open(Plan, 1, [local]) :-
    plan_journal(Plan, 1, Where, How),
    !,
    hosts_journal(Where, [sync(How)]).
lasting_open(_, _, _).

%!  lasting_back(+Plan, +Log) is det.
%
%   Restore the contents of the journal that lasting_open/3 has opened.  The
%   hosts get the options Log.  The endpoint of the process runs already.

lasting_back(Plan, Log) :-
    (   has_own_journal(Plan)
    ->  hosts_back(Log)
    ;   true
    ).

has_own_journal(Plan) :-
    plan_processes(Plan, 1, [local]),
    plan_journal(Plan, 1, Where, _),
    journal_place(Where, Place),
    durable_opened(Place).

%!  lasting_child(+Plan, ?Log, +P, -Options) is det.
%
%   Options for the child P, see child_start/6.  If Log is a list of options, it
%   replaces those of the hosts in the journal of the child.

lasting_child(Plan, Log, P, Options) :-
    plan_joins(Plan, Joins),
    (   plan_journal(Plan, P, Where, How)
    ->  Options = [journal(Where, How)|More],
        ( is_list(Log) -> More = [hosts(Log)|Joins] ; More = Joins )
    ;   Options = Joins
    ).

%!  lasting_goes_on(+Network, +P, +Plan) is det.
%
%   All processes have restored their journals: resume their agents.

lasting_goes_on(Network, P, Plan) :-
    (   plan_option(Plan, journal(_))
    ->  wire_go_on(Network, P)
    ;   true
    ).

%!  lasting_restarts(+Network, +P, +Plan, +Common) is det.
%
%   Restart children that die, if the plan has restart(true).  A restarted child
%   has the hosts of its journal, or without a journal those of the plan.

lasting_restarts(Network, P, Plan, Common) :-
    (   plan_option(Plan, restart(true))
    ->  nodes_restart(Network,
                         lasting_child(Plan, none),
                         restore_process(Network, Plan, P, Common))
    ;   true
    ).

restore_process(Network, Plan, Count, Common, P) :-
    plan_hosts(Plan, Count, Common, Hosts),
    (   plan_option(Plan, journal(_))
    ->  wire_again(Network, P, Hosts, [], []),
        node_order(Network, P, go_on, ok)
    ;   plan_links(Plan, Links),
        plan_host_setup(Plan, Goals),
        wire_again(Network, P, Hosts, Links, Goals)
    ).

%!  lasting_rests(+Plan) is semidet.
%
%   Stop the hosts of this process, and keep the contents of its journal.  Fails
%   if the open journal is not that of this network, or if the process has hosts
%   that are not in the network.  Then the caller ends the hosts of the network
%   for good.

lasting_rests(Plan) :-
    has_own_journal(Plan),
    plan_shape(Plan, Names, _),
    \+ ( host(Other, _, _), \+ memberchk(Other, Names) ),
    hosts_rest.

%!  lasting_over(+Plan) is det.
%
%   Delete the record of the network, if this process has opened its journal.

lasting_over(Plan) :-
    (   has_own_journal(Plan)
    ->  plan_option(Plan, journal(Where)),
        journal_record_drop(Where)
    ;   true
    ).

                /*******************************
                *       THE SAME NETWORK       *
                *******************************/

:- multifile
    prolog:error_message//1.

version(1).

%!  kept_plan(+Topology, +Options, -Plan, -Kept) is det.
%
%   Plan is that of network_plan/3.  Kept is kept(How, Clock) if the journal
%   holds a network, else `none`.
%
%   @error journal_of_another(Place, Was, Is), journal_damaged(Place, Why),
%   journal_version(Place, Version)

kept_plan(Topology, Options, Plan, Kept) :-
    check_options(network_option, Options),
    memberchk(journal(Where), Options),
    read_kept(Where, How, Plan0, Clock),
    !,
    journal_place(Where, Place),
    forall(member(Option, Options), unchanged(Option, Place, Plan0)),
    filled(Options, Plan0, All),
    network_plan(Topology, All, Plan),
    same_shape(Place, Plan0, Plan),
    Kept = kept(How, Clock).
kept_plan(Topology, Options, Plan, none) :-
    network_plan(Topology, Options, Plan).

%   unchanged(+Option, +Place, +Plan0): Option has the value that it has in
%   Plan0, or may change.

unchanged(Option, _, _) :-
    may_change(Option),
    !.
unchanged(Option, Place, Plan0) :-
    general(Option, General),
    (   plan_option(Plan0, General)
    ->  Was = General
    ;   functor(Option, Name, _),
        Was = no(Name)
    ),
    (   Was =@= Option
    ->  true
    ;   throw(error(journal_of_another(Place, Was, Option), _))
    ).

general(Option, General) :-
    functor(Option, Name, Arity),
    functor(General, Name, Arity).

may_change(journal(_)).
may_change(sync(_)).
may_change(restart(_)).
may_change(log(_)).
may_change(log(_, _)).
may_change(tls(_)).

%   Options that are not given keep the values of Plan0.

filled(Options, Plan0, All) :-
    plan_options(Plan0, Kept),
    exclude(given(Options), Kept, More),
    append(Options, More, All).

given(Options, Kept) :-
    member(Option, Options),
    same_option(Option, Kept),
    !.

same_option(Option, Kept) :-
    functor(Option, Name, Arity),
    functor(Kept, Name, Arity).
same_option(Option, Kept) :-
    functor(Option, log, _),
    functor(Kept, log, _).

same_shape(Place, Plan0, Plan) :-
    plan_shape(Plan0, Names0, Edges0),
    plan_shape(Plan, Names, Edges),
    (   Names0 == Names,
        Edges0 == Edges
    ->  true
    ;   throw(error(journal_of_another(Place,
                                       shape(Names0, Edges0),
                                       shape(Names, Edges)), _))
    ).

                /*******************************
                *            RECORD            *
                *******************************/

read_kept(Where, How, Plan, Clock) :-
    journal_place(Where, Place),
    journal_record(Where, Text),
    catch(term_string(Term, Text), error(Formal, _),
          throw(error(journal_damaged(Place, Formal), _))),
    version(Version),
    (   Term = network(Version0, _, _, _),
        Version0 \== Version
    ->  throw(error(journal_version(Place, Version0), _))
    ;   Term = network(_, How, Plan, Clock),
        plan_shape(Plan, _, _),
        Clock = clock(_, _)
    ->  true
    ;   throw(error(journal_damaged(Place, Term), _))
    ).

%!  kept_note(+Plan, +Clock, +How) is det.
%
%   Record that the network of Plan is `begun` or `built`, if it has a journal.
%
%   @error permission_error(open, journal, Place)

kept_note(Plan0, Clock, How) :-
    plan_option(Plan0, journal(Where)),
    !,
    plan_without(Plan0, [journal], Plan),       % may contain a password
    version(Version),
    format(string(Text), '~k.~n', [network(Version, How, Plan, Clock)]),
    journal_record_put(Where, Text).
kept_note(_, _, _).

prolog:error_message(journal_of_another(Place, Was, Is)) -->
    [ 'The journal ~p is that of another network: '-[Place] ],
    differs(Was, Is),
    [ '.', nl, 'Nothing in it was changed' ].

differs(shape(Names0, Edges0), shape(Names, Edges)) -->
    !,
    { length(Names0, N0), length(Edges0, E0),
      length(Names, N), length(Edges, E) },
    { counted(N0, host, Hosts0), counted(E0, link, Links0),
      counted(N, host, Hosts), counted(E, link, Links) },
    [ '~w, ~w, and not ~w, ~w'-[Hosts0, Links0, Hosts, Links] ].
differs(no(Name), Is) -->
    !,
    [ 'it has no ~w, and not ~p'-[Name, Is] ].
differs(Was, Is) -->
    [ '~p, and not ~p'-[Was, Is] ].
