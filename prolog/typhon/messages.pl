:- module(typhon_messages, []).

/** <module> What people are told about errors

The texts of the errors that the predicates of library(typhon) raise.  Who
mistypes the name of a host, an agent or an agent program is told which
names there are like it.  Rooms keep the texts of their own messages.

*Threading*: called by print_message/2 in any thread.
*/

:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module(api, [agent_property/2, host_property/2]).
:- use_module(near, [near_names/3]).

:- multifile prolog:error_message//1.

%   More names than these are not looked through for a near one.

most_names(2000).

                /*******************************
                *             ERRORS           *
                *******************************/

prolog:error_message(existence_error(host, Host)) -->
    [ 'There is no host ~p here'-[Host] ],
    meant(host, Host).
prolog:error_message(existence_error(agent, Agent)) -->
    [ 'There is no agent ~p'-[Agent] ],
    meant(agent, Agent).
prolog:error_message(existence_error(source_sink, Spec)) -->
    { program_alias(Spec, Alias, Name) },
    [ 'There is no file ~p'-[Spec] ],
    meant(Alias, Name).
prolog:error_message(existence_error(payload, Name)) -->
    [ 'There is no payload ~p'-[Name] ].
prolog:error_message(move_refused(Host, Reason)) -->
    [ '~p refuses to admit the agent: '-[Host] ],
    refusal(Reason).
prolog:error_message(host_unreachable(Host)) -->
    [ 'Host ~p cannot be reached'-[Host] ].
prolog:error_message(unreachable(Address)) -->
    [ 'Nothing answers at ~p'-[Address] ].
prolog:error_message(connection_lost(Address)) -->
    [ 'The connection to ~p was lost before the answer came'-[Address] ].
prolog:error_message(type_error(mobile_term, Culprit)) -->
    [ 'This term cannot travel: ~p'-[Culprit] ].

refusal(capacity) --> !, [ 'it is full' ].
refusal(token) --> !, [ 'none of its tokens is wanted there' ].
refusal(unknown_host) --> !, [ 'there is no host of that name' ].
refusal(Reason) --> [ '~p'-[Reason] ].

program_alias(Spec, Alias, Name) :-
    compound(Spec),
    compound_name_arguments(Spec, Alias, [Name]),
    memberchk(Alias, [agents, payloads]),
    atom(Name).

                /*******************************
                *          NEAR NAMES          *
                *******************************/

meant(Kind, Name) -->
    { atom(Name),
      most_names(Most),
      findall(Known, limit(Most, known(Kind, Known)), Names0),
      sort(Names0, Names),
      near_names(Name, Names, Near),
      Near \== []
    },
    !,
    { atomic_list_concat(Near, ' or ', Text) },
    [ ' (did you mean ~w?)'-[Text] ].
meant(_, _) -->
    [].

known(host, Host) :-
    host_property(Host, state(_)).
known(agent, Agent) :-
    agent_property(Agent, state(_)).
known(agents, Name) :-
    program_name(agents, Name).
known(payloads, Name) :-
    program_name(payloads, Name).

%   Name as it would stand in agents(Name), for programs in folders, too.

program_name(Alias, Name) :-
    Spec =.. [Alias, '.'],
    absolute_file_name(Spec, Dir,
                       [ file_type(directory), solutions(all),
                         file_errors(fail)
                       ]),
    directory_member(Dir, File, [extensions([pl]), recursive(true)]),
    atomic_list_concat([Dir, /, Relative], File),
    file_name_extension(Name, pl, Relative).
