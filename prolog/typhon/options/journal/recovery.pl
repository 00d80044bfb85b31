:- module(typhon_recovery,
          [ hosts_journal/2,            % +Where, +Options
            hosts_back/1                % +Options
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3, member/2, selectchk/3]).
:- use_module(library(option), [option/3]).
:- use_module('../../kernel/base/durable',
              [ durable/6, durable_close/0, durable_drop_all/2, durable_end/0,
                durable_item/5, durable_kinds/2, durable_opened/1,
                durable_order/2, durable_restore/4 ]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/host',
              [ guests_leave/0, host/3, host_again/1, host_begin/2,
                host_end/1, host_note/1, hosts_exclusively/1, hosts_go_on/0,
                time_apart/2, time_wanted/2 ]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3]).
:- use_module('../../kernel/lifecycle', [agent_reschedule/1]).
:- use_module('../../kernel/wire', [endpoint_address/1, endpoint_open/0]).
:- use_module(units_of_work, [changes_begin/0, changes_number_after/1]).
:- use_module(journaled_agents, [agent_back/3, states_unused/1]).
:- use_module(store, [journal_open/3, journal_place/2]).

/** <module> Recovery: hosts that start with a journal

The first host of a process with the option journal(Where) opens the journal.
Then all hosts in the journal start, and its other items are restored.  First
all state is restored, while no peer is accepted and no agent runs, see
typhon_durable.  Then the process continues: agents that are due, or were about
to run, are scheduled, alarms are set, and unfinished transfers are queried or
sent again.

*Threading*: as host_start/2.
*/

:- multifile
    typhon_code:in_use/1,
    typhon_durable:go_on/0,
    typhon_durable:recover/0,
    typhon_durable:tidy/0,
    typhon_host_parts:ends/1,
    typhon_host_parts:unnoted/1,
    typhon_hosting:starts/2,
    typhon_runtime:ending/1.

:- dynamic
    restored/1,                 % Name: host started from the journal
    superfluous/2,              % Kind, Key: no agent needs it
    not_restored/2.             % Id, Hash: an agent that was not restored

%   last(-Kinds): kinds that need others restored first; mail and programs of
%   agents that are not there are superfluous.

last([agent, mail, wait, code]).

%   State that this process had before, with another journal or none, is
%   discarded.

typhon_durable:recover :-
    forall(typhon_identity:ids_anew, true),
    last(Last),
    durable_kinds(Last, Kinds),
    forall(( member(Kind, Kinds),
             durable_order(Kind, Order),
             durable_item(Kind, Order, Key, N, Term) ),
           restore_item(Kind, Key, N, Term)),
    forall(typhon_durable:restored, true).

%   Programs are restored with their agents.

restore_item(code, Hash, _, _) :-
    !,
    (   ( agent(_, _, _, Hash, _) ; not_restored(_, Hash) )
    ->  true
    ;   assertz(superfluous(code, Hash))
    ).
restore_item(mail, Id, _, _) :-
    \+ agent(Id, _, _, _, _),
    !,
    (   not_restored(Id, _)
    ->  true
    ;   assertz(superfluous(mail, Id))
    ).
restore_item(Kind, Key, N, Term) :-
    catch(durable_restore(Kind, Key, N, Term), error(Formal, Context), true),
    !,
    (   var(Formal)
    ->  true
    ;   print_message(error, typhon(not_back(Kind, Key))),
        print_error(error, error(Formal, Context)),
        note_not_restored(Kind, Key, Term)
    ).
restore_item(Kind, Key, _, Term) :-
    print_message(error, typhon(not_back(Kind, Key))),
    note_not_restored(Kind, Key, Term).

%   An item that stays in the journal keeps all that belongs to it.

note_not_restored(agent, Id, agent(_, Hash, _, _, _, _)) :-
    !,
    assertz(not_restored(Id, Hash)).
note_not_restored(_, _, _).

typhon_code:in_use(Hash) :-
    not_restored(_, Hash),
    !.

typhon_runtime:ending(after) :-
    retractall(not_restored(_, _)).

%   typhon_journaled_agents writes these items.

:- durable(agent, Id, 0, Record, fail, restore_agent(Id, Record)).

restore_agent(Id, Record) :-
    Record = agent(Host, _, _, _, _, _),
    host(Host, _, Place),
    agent_back(Id, Record, Place),
    host_again(Host),
    debug(typhon(agent), '~w: is there again, on ~w', [Id, Host]).

%   This runs before the process accepts requests, which might need the items.

typhon_durable:tidy :-
    forall(retract(superfluous(Kind, Key)), durable_drop_all(Kind, Key)),
    states_unused(Ids),
    forall(( member(Id, Ids), \+ not_restored(Id, _) ),
           durable_drop_all(state, Id)).

typhon_durable:go_on :-
    findall(Id, agent_status(Id, _, _), All),
    forall(member(Id, All), agent_reschedule(Id)).

                /*******************************
                *            HOSTS             *
                *******************************/

%   A host that was restored may be started once more, which changes nothing.

typhon_hosting:starts(Name, Options) :-
    (   retract(restored(Name))
    ->  true
    ;   memberchk(journal(Where), Options),
        \+ host(Name, _, _),
        journal_place(Where, Place),
        \+ durable_opened(Place),
        start_from(Where, Name, Options)
    ).

%   The URL of the journal may contain a password.

typhon_host_parts:unnoted(journal(_)).
typhon_host_parts:unnoted(sync(_)).

typhon_host_parts:ends(Name) :-
    retractall(restored(Name)).

%   start_from(+Where, +Name, +Options): start Name and all of the journal.

start_from(Where, _, Options) :-
    time_wanted(Options, Kind),
    time_apart(Kind, _),
    !,
    format(atom(Why), 'not in ~w time', [Kind]),
    not_here(Where, Why).
start_from(Where, Name, Options) :-
    open_journal(Where, Options),
    catch(begin_from_journal(Name, Options), Ball,
          ( durable_close, give_up_hosts, durable_end, throw(Ball) )).

begin_from_journal(Name, Options) :-
    findall(Other-Known, journaled_host(Other, Known), Hosts),
    (   selectchk(Name-Known, Hosts, Others)
    ->  with_known(Known, Options, AllOptions)
    ;   AllOptions = Options,
        Others = Hosts
    ),
    host_begin(Name, AllOptions),
    restore_all(Others),
    hosts_go_on.

restore_all(Hosts) :-
    forall(member(Name-Options, Hosts),
           ( host_begin(Name, Options),
             assertz(restored(Name)) )),
    forall(typhon_durable:recover, true),
    changes_begin,
    forall(typhon_durable:tidy, true),
    forall(host(Host, _, _), host_note(Host)),
    endpoint_open.

give_up_hosts :-
    retractall(restored(_)),
    forall(host(Name, _, _), ignore(host_end(Name))).

%   @error permission_error(open, journal, Place), and as journal_open/3

open_journal(Where, _) :-
    guests_leave,
    endpoint_address(_),
    !,
    not_here(Where, 'this process has hosts already').
open_journal(Where, Options) :-
    option(sync(Sync), Options, normal),
    option(wait(Seconds), Options, 0.2),
    journal_open(Where, Sync, Seconds),
    catch(forall(durable_item(number, any, _, _, N),
                 changes_number_after(N)), Ball,
          ( durable_end, throw(Ball) )).

not_here(Where, Why) :-
    journal_place(Where, Place),
    throw(error(permission_error(open, journal, Place), context(_, Why))).

%   journaled_host(?Name, -Options) is nondet: the journal holds the host Name.

journaled_host(Name, Options) :-
    durable_item(host, numbers, Name, _, Options).

%   with_known(+Known, +Options, -All): All are Options, and those of Known that
%   Options do not override.

with_known(Known, Options, All) :-
    findall(Option,
            ( member(Option, Known),
              functor(Option, OptionName, Arity),
              functor(Given, OptionName, Arity),
              \+ memberchk(Given, Options) ),
            More),
    append(Options, More, All).

%!  hosts_journal(+Where, +Options) is det.
%!  hosts_back(+Options) is det.
%
%   The two steps by which a host with the option journal(Where) starts, for
%   callers that act between them, or have no host yet.  hosts_journal/2 opens
%   the journal; then the process may start its endpoint.  hosts_back/1 restores
%   the journal and accepts peers; Options override those of the restored hosts.
%   Then the caller must call hosts_go_on/0.
%
%   @arg Options of hosts_journal/2 are sync(How), as of host_start/2, and
%        wait(Seconds): how long to wait for another process that has the
%        journal and is about to end
%   @error permission_error(open, journal, Place), and as journal_open/3

hosts_journal(Where, Options) :-
    hosts_exclusively(open_journal(Where, Options)).

hosts_back(Options) :-
    findall(Name-All,
            ( journaled_host(Name, Known), with_known(Known, Options, All) ),
            Hosts),
    hosts_exclusively(restore_all(Hosts)).
