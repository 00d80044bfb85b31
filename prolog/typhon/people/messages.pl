:- module(typhon_messages, []).

/** <module> What people are told about errors

The texts of the errors that the predicates of library(typhon) raise, and
of what is reported about agents.  Who mistypes the name of a host, an agent
or an agent program is told which names there are like it.  The rooms of
the wire, of networks and of the log keep the texts of their own messages.

*Threading*: called by print_message/2 in any thread.
*/

:- use_module(library(apply), [foldl/6]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [last/2, member/2, min_list/2, numlist/3]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../host', [host_property/2]).
:- use_module('../lifecycle', [agent_property/2]).

:- multifile
    prolog:error_message//1,
    prolog:message//1.

%   More names than these are not looked through for a near one.

most_names(2000).

                /*******************************
                *             ERRORS           *
                *******************************/

prolog:error_message(existence_error(host, here)) -->
    !,
    [ 'This process has no host' ].
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
prolog:error_message(existence_error(endpoint, running)) -->
    [ 'This process has no host: start one with host_start/1'-[] ].
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
                *            REPORTS           *
                *******************************/

prolog:message(typhon(faulty(Agent, Error))) -->
    [ 'Agent ~w raised an error, and is kept as it was:'-[Agent], nl ],
    explained(Error).
prolog:message(typhon(agent_failed(Agent))) -->
    [ 'Agent ~w has failed'-[Agent] ].
prolog:message(typhon(ended_in_doubt(Agent, Address))) -->
    [ 'Agent ~w has ended here while in doubt: if it has arrived at ~w, '-
      [Agent, Address],
      'it ends there as soon as that is known' ].
prolog:message(typhon(message_failed(Agent, From, Message))) -->
    [ 'Agent ~w does not understand a message: ~p from ~w'-
      [Agent, Message, From] ].
prolog:message(typhon(order_failed(Agent, refused(Reason)))) -->
    !,
    [ 'Agent ~w could not obey: '-[Agent] ],
    refusal(Reason).
prolog:message(typhon(order_failed(Agent, Formal))) -->
    [ 'Agent ~w could not obey: '-[Agent] ],
    explained(error(Formal, _)).
prolog:message(typhon(undeliverable(Formal, Agent, From, Message))) -->
    [ 'A message for ~w is lost: ~p from ~w'-[Agent, Message, From], nl ],
    lost_since(Formal).
prolog:message(typhon(undeliverable(Formal, Agent, From, Message, Others))) -->
    [ 'Messages for ~w are lost: ~p from ~w, and ~D more'-
      [Agent, Message, From, Others], nl ],
    lost_since(Formal).
prolog:message(typhon(log(Host, Agent, What))) -->
    [ '~w at ~w: ~p'-[Agent, Host, What] ].
prolog:message(typhon(told(Agent, Message))) -->
    [ '~w says ~p'-[Agent, Message] ].
prolog:message(typhon(checked(Program, 0, 0, 0))) -->
    !,
    [ '~p is in order'-[Program] ].
prolog:message(typhon(checked(Program, Errors, Doubts, Undefined))) -->
    [ '~p: ~d errors, '-[Program, Errors] ],
    doubts(Doubts),
    [ '~d calls of what others must define'-[Undefined] ].
prolog:message(typhon(place_reloaded(Place, File))) -->
    { host_property(Host, place(Place)) -> true ; Host = Place },
    [ '~w is loaded anew into the place of ~w'-[File, Host] ].
prolog:message(typhon(stuck_worker(Worker))) -->
    [ 'Worker ~p does not stop: its agent neither ends nor yields'-
      [Worker] ].
prolog:message(typhon(goal_failed(Goal))) -->
    [ 'This should not have failed: ~p'-[Goal] ].
prolog:message(typhon(run_failed(Agent))) -->
    [ 'The step of agent ~w was not completed'-[Agent] ].

doubts(0) --> !.
doubts(N) --> [ '~d warnings, '-[N] ].

lost_since(existence_error(agent, _)) -->
    !,
    [ 'There is no such agent, or its process has died' ].
lost_since(Formal) -->
    explained(error(Formal, _)).

explained(Error) -->
    '$messages':translate_message(Error).

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
    atom_concat(Dir, /, Start),
    atom_concat(Start, Relative, File),
    file_name_extension(Name, pl, Relative).

%   near_names(+Name, +Names, -Near)
%
%   Near are up to three of Names that a person may have meant by Name, the
%   nearest first.  An id or address also counts by what stands before the
%   first `.` or `@`, a path by its last part: `census` finds
%   'census.4f2a1@alpha@...', and 'survey/census'.

near_names(Name, Names, Near) :-
    findall(Distance-Candidate,
            ( member(Candidate, Names),
              distance(Name, Candidate, Distance)
            ),
            Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, All),
    findall(One, limit(3, member(One, All)), Near).

distance(Name, Candidate, Distance) :-
    atom_string(Name, Text),
    atom_string(Candidate, Whole),
    short(Whole, Short),
    short(Text, Plain),
    edit_distance(Text, Whole, D1),
    edit_distance(Text, Short, D2),
    edit_distance(Plain, Short, D3),
    min_list([D1, D2, D3], Distance),
    string_length(Plain, Length),
    Distance =< 1 + Length//4.

short(Text, Short) :-
    split_string(Text, ".@", "", [Head|_]),
    split_string(Head, "/", "", Parts),
    last(Parts, Short).

%   Levenshtein's distance, row by row.

edit_distance(A, B, Distance) :-
    string_codes(A, As),
    string_codes(B, Bs),
    length(Bs, N),
    numlist(0, N, Row),
    distance_rows(As, Bs, Row, Distance).

distance_rows([], _, Row, Distance) :-
    last(Row, Distance).
distance_rows([A|As], Bs, [D|Ds], Distance) :-
    D1 is D+1,
    foldl(distance_step(A), Bs, Ds, Row, D-D1, _),
    distance_rows(As, Bs, [D1|Row], Distance).

distance_step(A, B, Up, New, Diagonal-Left, Up-New) :-
    (   A == B
    ->  Change = Diagonal
    ;   Change is Diagonal+1
    ),
    New is min(Change, min(Up, Left)+1).
