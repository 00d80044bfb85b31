:- module(typhon_messages, []).

/** <module> Texts of errors

This module has the texts of the errors that the predicates of library(typhon)
raise, and of reports about agents.  For a mistyped name of a host, an agent or
an agent program they suggest similar names.  The modules of the wire, of
networks and of the log have the texts of their own messages.

*Threading*: print_message/2 calls the hooks in any thread.
*/

:- use_module('../kernel/base/error_text',
              [abridged/3, error_lines/3, term_lines/3]).
:- use_module('../kernel/base/text', [shown_text/3]).
:- use_module('../kernel/wire', [endpoint_missed/2, refusal_text/2]).
:- autoload('../language', [files_beside/3]).
:- use_module('../kernel/host',
              [address_parts/3, host_resolve/2]).
:- use_module(administration, [host_property/2]).
:- use_module('../kernel/base/names',
              [ counted/3, names/2, names_joined/3, names_listed/2,
                names_proposed/3 ]).
:- use_module('../kernel/travel', [agent_outcome/2]).
:- use_module(event_text, [event_lines/3, short_name/2]).

:- multifile
    prolog:error_message//1,
    prolog:message//1.

                /*******************************
                *             ERRORS           *
                *******************************/

prolog:error_message(existence_error(host, here)) -->
    !,
    [ 'This process has no host' ].
prolog:error_message(existence_error(host, Host)) -->
    { elsewhere(Host, Address) },
    !,
    { address_parts(Address, Name, _) },
    [ 'Host ~w is not in this process: call Goal in its process with \c
       remote(~q, Goal), such as typhon:host_stop(~q)'-
      [Address, Address, Name] ].
prolog:error_message(existence_error(host, Host)) -->
    { address_parts(Host, Name, Endpoint) },
    !,
    [ 'There is no host ~w at ~w'-[Name, Endpoint] ],
    meant(host, Name).
prolog:error_message(existence_error(host, Host)) -->
    [ 'There is no host ~p here'-[Host] ],
    meant(host, Host).
prolog:error_message(ambiguous_host(Name, Addresses)) -->
    { names_joined(Addresses, ', ', Text) },
    [ 'Several hosts are called ~w: ~w'-[Name, Text] ].
prolog:error_message(permission_error(start, host, Host)) -->
    [ 'There is a host ~p here already'-[Host] ].
prolog:error_message(permission_error(start, page, Port)) -->
    [ 'There is a page already, at port ~w'-[Port] ].
prolog:error_message(permission_error(overwrite, Kind, File)) -->
    { atomic_list_concat(Words, '_', Kind),
      atomic_list_concat(Words, ' ', Text) },
    [ '~w is not overwritten, as it is no ~w: name another file'-
      [File, Text] ].
prolog:error_message(existence_error(log_events, File)) -->
    [ '~w has no events: it is not a log, or is empty'-[File] ].
prolog:error_message(permission_error(carry, virtual_time, Option)) -->
    [ 'Virtual time is that of one process: ~p cannot be had with \c
       clock(virtual)'-[Option] ].
prolog:error_message(existence_error(agent, Agent)) -->
    { agent_outcome(Agent, Outcome),
      functor(Outcome, How, _)
    },
    !,
    [ 'Agent ~p has ended: ~w'-[Agent, How] ].
prolog:error_message(existence_error(agent, Agent)) -->
    [ 'There is no agent ~p'-[Agent] ],
    meant(agent, Agent).
prolog:error_message(existence_error(fleet, any(Tag))) -->
    [ 'any(~p) chooses a host of a fleet, and this process has not joined one: \c
       see fleet_join/2'-[Tag] ].
prolog:error_message(existence_error(fleet, Fleet)) -->
    [ 'This process has not joined a fleet ~p: see fleet_join/2'-[Fleet] ],
    meant(fleet, Fleet).
prolog:error_message(existence_error(fleet_of_host, Host)) -->
    [ 'Host ~w is in no fleet, or was drained'-[Host] ].
prolog:error_message(existence_error(tag, Tag)) -->
    [ 'No host has the tag ~p'-[Tag] ],
    meant(tag, Tag).
prolog:error_message(resource_error(hosts(Tag))) -->
    [ 'All hosts with the tag ~p are away'-[Tag] ].
prolog:error_message(ambiguous_agent(Name, Ids)) -->
    { atomic_list_concat(Ids, ', ', Text) },
    [ 'Several agents are called ~w: ~w'-[Name, Text] ].
prolog:error_message(timeout_error(order, Agent)) -->
    [ 'Agent ~p has not carried out the order in time'-[Agent] ].
prolog:error_message(existence_error(source_sink, Spec)) -->
    { program_alias(Spec, Alias, Name) },
    [ 'There is no file ~p'-[Spec] ],
    meant(Alias, Name).
prolog:error_message(existence_error(source_sink, Spec)) -->
    { compound(Spec),
      compound_name_arity(Spec, Alias, 1),
      names_proposed(Alias, [agents(_), payloads(_)], Meant),
      Meant \== ''
    },
    [ 'There is no file ~p~w'-[Spec, Meant] ].
prolog:error_message(existence_error(source_sink, File)) -->
    { atom(File),
      files_beside(File, '.', Files),
      names_proposed(File, Files, Meant),
      Meant \== ''
    },
    [ 'There is no file ~p~w'-[File, Meant] ].
prolog:error_message(existence_error(state, Name/Arity, Declared)) -->
    { names_proposed(Name, Declared, Meant),
      names_listed(Declared, All)
    },
    [ 'The program does not declare ~p as state~w~w'-
      [Name/Arity, Meant, All] ].
prolog:error_message(existence_error(network, Network)) -->
    [ 'There is no network ~p'-[Network] ],
    meant(network, Network).
prolog:error_message(existence_error(result, Agent)) -->
    [ 'Agent ~p gave no result'-[Agent] ].
prolog:error_message(existence_error(endpoint, running)) -->
    [ 'This process has no host: start one with host_start/1'-[] ].
prolog:error_message(existence_error(payload, Name)) -->
    [ 'There is no payload ~p'-[Name] ].
prolog:error_message(move_refused(Name, unknown_host)) -->
    { atom(Name), \+ sub_atom(Name, _, _, _, @) },
    !,
    [ '~w refuses to admit the agent: there is no host of that name in the \c
       process of the agent'-[Name] ],
    meant(host, Name),
    [ '; for other processes let it carry the address, as \c
       host_property(~q, address(A)) gives it'-[Name] ].
prolog:error_message(move_refused(Host, Reason)) -->
    [ '~p refuses to admit the agent: '-[Host] ],
    refusal(Reason),
    ( { Reason == unknown_host } -> meant(host, Host) ; [] ).
prolog:error_message(host_unreachable(Host)) -->
    [ 'Host ~p cannot be reached'-[Host] ],
    reason(Host).
prolog:error_message(permission_error(authenticate, host, Host)) -->
    [ 'The process of ~p has another cookie than this one (see \c
       TYPHON_COOKIE_FILE)'-[Host] ].
prolog:error_message(unreachable(Address)) -->
    [ 'Nothing answers at ~p'-[Address] ],
    reason(Address).
prolog:error_message(connection_lost(Address)) -->
    [ 'The connection to ~p was lost before the answer came'-[Address] ].
prolog:error_message(type_error(mobile_term, Culprit)) -->
    [ 'This term cannot travel: ~p'-[Culprit] ].

%   reason(+Host)//: the text tells why this process could not reach Host, the
%   address of a host or a process.

reason(Host) -->
    { endpoint_of(Host, Endpoint),
      endpoint_missed(Endpoint, Formal),
      missed(Formal, Text)
    },
    !,
    [ ': ~w'-[Text] ].
reason(_) -->
    [].

endpoint_of(Host, Endpoint) :-
    (   address_parts(Host, _, Endpoint)
    ->  true
    ;   Endpoint = Host
    ).

missed(late, 'it does not answer').
missed(timeout_error(_, _), 'it does not answer').
missed(socket_error(_, Text0), Text) :-
    downcase_atom(Text0, Text).
missed(permission_error(authenticate, peer, cookie),
       'it has another cookie').
missed(permission_error(authenticate, peer, protocol),
       'something else answers there').
missed(permission_error(authenticate, peer, version(Version)), Text) :-
    format(atom(Text), 'it speaks another version of the protocol, ~w',
           [Version]).
missed(permission_error(authenticate, peer, Why), Text) :-
    refusal_text(Why, Text).
missed(permission_error(use, cookie_file, File), Text) :-
    format(atom(Text), 'the cookie file ~w may not be used', [File]).

refusal(capacity) --> !, [ 'it is full' ].
refusal(token) --> !, [ 'none of its tokens is wanted there' ].
refusal(unsigned) --> !, [ 'no author that it trusts has signed its code' ].
refusal(identity) --> !, [ 'its owner has not signed its identity' ].
refusal(unknown_host) --> !, [ 'there is no host of that name' ].
refusal(quota(What)) --> !, [ 'the quota of ~w would be exceeded'-[What] ].
refusal(Reason) --> term_lines(Reason).

program_alias(Spec, Alias, Name) :-
    compound(Spec),
    compound_name_arguments(Spec, Alias, [Name0]),
    memberchk(Alias, [agents, payloads]),
    program_path(Name0, Name).

%   program_path(+Path, -Name): Path is the argument in agents(census) or
%   agents(survey/census).

program_path(Name, Name) :-
    atom(Name),
    !.
program_path(Path, Name) :-
    compound(Path),
    Path = Folder/File,
    program_path(Folder, Begin),
    atom(File),
    atomic_list_concat([Begin, File], /, Name).

                /*******************************
                *            REPORTS           *
                *******************************/

prolog:message(typhon(ended_in_doubt(Agent, Address))) -->
    [ 'Agent ~w has ended here while in doubt: if it has arrived at ~w, '-
      [Agent, Address],
      'it ends there as soon as that is known' ].
prolog:message(typhon(news_too_long(Agent))) -->
    [ 'The news of agent ~w is too long to be sent to its home'-
      [Agent] ].
prolog:message(typhon(results_lost(Agent))) -->
    [ 'The outcome of agent ~w, with its result, is too long to be sent \c
       to its home'-[Agent] ].
prolog:message(typhon(message_failed(Agent, From, Message))) -->
    [ 'Agent ~w does not understand a message: '-[Agent] ],
    message_from(Message, From).
prolog:message(typhon(order_failed(Agent, refused(Reason)))) -->
    !,
    [ 'Agent ~w could not obey: '-[Agent] ],
    refusal(Reason).
prolog:message(typhon(order_failed(Agent, Formal))) -->
    [ 'Agent ~w could not obey: '-[Agent] ],
    error_lines(error(Formal, _)).
prolog:message(typhon(not_let_in(Where, Formal))) -->
    [ '~w: a host with this policy refuses it: '-[Where] ],
    error_lines(error(Formal, _)).
prolog:message(typhon(over_limit(Agent, What))) -->
    [ 'Agent ~w is ended: it has used more ~w than its host allows'-
      [Agent, What] ].
prolog:message(typhon(aborted(Agent))) -->
    [ 'Agent ~w is ended: its goal was aborted, by abort/0 in it, by the \c
       debugger, or by a signal'-[Agent] ].
prolog:message(typhon(exhausted(Agent, What))) -->
    [ 'Agent ~w is ended: it has raised ~p'-[Agent, resource_error(What)] ].
prolog:message(typhon(runs_on(Agent, Seconds))) -->
    [ 'Agent ~w runs on after ~w s: it is disposed of when it stops next.'-
      [Agent, Seconds], nl,
      'agent_dispose(Agent, [force(Seconds)]) interrupts it' ].
prolog:message(typhon(not_back(Kind, Key))) -->
    [ 'The journal has ~w ~w, which cannot be restored; it stays there'
      -[Kind, Key] ].
prolog:message(typhon(journal_in_words(Agent))) -->
    [ '~w holds terms that cannot be written: the journal has them as text'
      -[Agent] ].
prolog:message(typhon(not_from(Peer, Agent, From))) -->
    { named(Agent, Agent1), named(From, From1) },
    [ 'A message for ~w from ~w is not delivered: ~w has no right to send \c
       in the name of that agent'-[Agent1, From1, Peer] ].
prolog:message(typhon(undeliverable(resource_error(frame_bytes), Agent, From,
                                    _))) -->
    !,
    { named(Agent, Agent1), named(From, From1) },
    [ 'A message for ~w from ~w is too long to be sent'-[Agent1, From1] ].
prolog:message(typhon(undeliverable(Formal, Agent, From, Message))) -->
    { named(Agent, Agent1) },
    [ 'A message for ~w is lost: '-[Agent1] ],
    message_from(Message, From),
    [ nl ],
    lost_since(Formal).
prolog:message(typhon(undeliverable(Formal, Agent, From, Message, Others))) -->
    { named(Agent, Agent1) },
    [ 'Messages for ~w are lost: '-[Agent1] ],
    message_from(Message, From),
    [ ', and ~D more'-[Others], nl ],
    lost_since(Formal).
prolog:message(typhon(log(Host, Agent, What))) -->
    [ '~w at ~w: '-[Agent, Host] ],
    term_lines(What).
prolog:message(typhon(log_unheard(Endpoint))) -->
    [ 'The log server at ~w does not answer'-[Endpoint] ],
    reason(Endpoint),
    [ '. Events are not logged until it does'-[] ].
prolog:message(typhon(log_heard(Endpoint, Count))) -->
    { counted(Count, event, Lost) },
    [ 'The log server at ~w answers again; the log is without ~w'-
      [Endpoint, Lost] ].
prolog:message(typhon(traced(Agent, Host, What))) -->
    happened(Agent, Host),
    event_lines(What).
prolog:message(typhon(stepped(Agent, held(Host, Goal)))) -->
    !,
    happened(Agent, Host),
    [ 'next is ' ],
    event_lines(goal(Goal)).
prolog:message(typhon(spied(Agent, Host, Goal))) -->
    happened(Agent, Host),
    [ 'is held before ' ],
    event_lines(goal(Goal)).
prolog:message(typhon(spy(Program, Name, Arity))) -->
    [ 'Agents of ~p are held before ~p'-[Program, Name/Arity] ].
prolog:message(typhon(spied_none(Program, PI, Meant))) -->
    [ 'There is no ~p in ~p~w'-[PI, Program, Meant] ].
prolog:message(typhon(nospy(Program, Name, Arity))) -->
    [ 'Agents of ~p are not held before ~p any more'-[Program, Name/Arity] ].
prolog:message(typhon(stepped(Agent, What))) -->
    [ '% ~w '-[Agent] ],
    stopped(What).
prolog:message(typhon(told(Agent, Message))) -->
    [ '~w says '-[Agent] ],
    term_lines(Message).
prolog:message(typhon(checked(Program, 0, 0, 0))) -->
    !,
    [ '~p is in order'-[Program] ].
prolog:message(typhon(checked(Program, Errors, Doubts, Undefined))) -->
    { counted(Errors, error, Wrong), counted(Undefined, call, Calls) },
    [ '~p: ~w, '-[Program, Wrong] ],
    doubts(Doubts),
    [ '~w of what others must define'-[Calls] ].
prolog:message(typhon(place_reloaded(Place, File))) -->
    { host_property(Host, place(Place)) -> true ; Host = Place },
    [ '~w is reloaded into the place of ~w'-[File, Host] ].
prolog:message(typhon(stuck_worker(Worker))) -->
    [ 'Worker ~p does not stop: its agent neither ends nor yields'-
      [Worker] ].
prolog:message(typhon(goal_failed(Goal))) -->
    [ 'This goal failed unexpectedly: ~p'-[Goal] ].
prolog:message(typhon(run_failed(Agent))) -->
    [ 'The step of agent ~w was not completed'-[Agent] ].

doubts(0) --> !.
doubts(N) --> { counted(N, warning, Text) }, [ '~w, '-[Text] ].

happened(Agent, Host) -->
    { short_name(Agent, Name),
      short_name(Host, Where)
    },
    [ '% ~w at ~w: '-[Name, Where] ].

stopped(rests(State)) --> !, [ 'is ~w'-[State] ].
stopped(ended(Outcome)) --> [ 'has ended, ' ], term_lines(Outcome).

lost_since(existence_error(agent, _)) -->
    !,
    [ 'There is no such agent, or its process has died' ].
lost_since(resource_error(backlog)) -->
    !,
    [ 'Too many messages wait for agents that cannot be reached \c
       (setting typhon_backlog:messages)' ].
lost_since(resource_error(mailbox)) -->
    !,
    [ 'Its mailbox is full' ].
lost_since(Formal) -->
    error_lines(error(Formal, _)).

message_from(Message, From) -->
    { named(From, From1) },
    term_lines(Message),
    [ ' from ~w'-[From1] ].

%   named(+Name, -Shown): the recipient of a message, and its claimed sender,
%   may be any term.

named(Name, Shown) :-
    (   atom(Name)
    ->  shown_text(Name, 200, Shown)
    ;   abridged(Name, 200, Shown)
    ).

meant(Kind, Name) -->
    { names(Kind, Names),
      names_proposed(Name, Names, Text)
    },
    [ '~w'-[Text] ].

%   elsewhere(+Host, -Address) is semidet.
%
%   Host, a name or an address, is in a network of this process, but in another
%   process.

elsewhere(Host, Address) :-
    atom(Host),
    catch(host_resolve(Host, remote(Address, _, _)), error(_, _), fail),
    names(host, Names),
    memberchk(Address, Names).
