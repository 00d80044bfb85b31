:- module(typhon_app_usage,
          [ complain/2                  % +Command, +Error
          ]).

/** <module> Error messages of the command line

*Threading*: the main thread only.
*/

:- use_module('../../prolog/typhon/kernel/base/error_text',
              [error_lines/3, print_error/2]).
:- use_module('../../prolog/typhon/kernel/base/names',
              [counted/3, names_listed/2, names_proposed/3]).
:- use_module(commands, [command/4]).

:- multifile
    prolog:error_message//1,
    prolog:message//1.

%!  complain(+Command, +Error) is det.
%
%   Prints Error, which Command has raised, and a hint.

complain(_, error(io_error(write, Stream), context(_, 'Broken pipe'))) :-
    stream_property(Stream, alias(user_output)),
    !.                                  % its reader, as head(1), closed it
complain(Command, Error0) :-
    without_predicate(Error0, Error),
    (   Error = error(Formal, Context),
        ( hint(Formal, Hint) ; no_program(Command, Formal, Context, Hint) )
    ->  print_message(error, typhon_hint(Error, Hint))
    ;   print_error(error, Error)
    ).

%   The user of a command has called no predicate.

without_predicate(error(Formal, Context), error(Formal, context(_, Text))) :-
    subsumes_term(context(raised(_), _), Context),
    !,
    Context = context(_, Text).
without_predicate(Error, Error).

%   The command to try next.

hint(host_unreachable(Host), Hint) :-
    format(atom(Hint), 'diagnose ~w finds the cause', [Host]).
hint(connection_lost(Host), Hint) :-
    format(atom(Hint), 'diagnose ~w finds the cause', [Host]).
hint(existence_error(agent, _), 'agents --host ADDRESS lists agents').
hint(existence_error(host, _), 'hosts --host ADDRESS lists hosts').
hint(domain_error(topology, _), 'network --help lists the shapes').

%   Not for a file that a program includes: the user did not type it.

no_program(Command, existence_error(source_sink, _), Context,
           'a file, or a term as agents(census)') :-
    \+ subsumes_term(at(_, _, _), Context),
    command(Command, Arguments, _, _),
    sub_atom(Arguments, 0, _, _, 'PROGRAM').

prolog:message(typhon_hint(Error, Hint)) -->
    error_lines(Error),
    [ ' (~w)'-[Hint] ].

prolog:error_message(typhon_usage(Problem)) -->
    usage(Problem).

usage(unknown_command(Word, Commands)) -->
    { names_proposed(Word, Commands, Meant),
      names_listed(Commands, All)
    },
    [ 'no command ~w~w~w'-[Word, Meant, All] ].
usage(unknown_option(Command, Option, Options)) -->
    { names_proposed(Option, Options, Meant),
      names_listed(Options, All)
    },
    [ '~w has no option --~w~w~w'-[Command, Option, Meant, All] ].
usage(arguments(Command, _)) -->
    { command(Command, '', _, _) },
    !,
    [ '~w takes options only; see ~w --help'-[Command, Command] ].
usage(arguments(send, [_,Word,Next|Words])) -->
    !,
    { atomic_list_concat([Word,Next|Words], ' ', Text) },
    usage(message(Text)).
usage(arguments(Command, _)) -->
    { command(Command, Arguments, _, _) },
    [ '~w takes ~w; see ~w --help'-[Command, Arguments, Command] ].
usage(message(Text)) -->
    { term_to_atom(Text, Quoted) },
    [ 'a message is a Prolog term; text is written in quotes: "~w"'-
      [Quoted] ].
usage(option(Command, missing_value(Option, _))) -->
    [ '--~w needs a value; see ~w --help'-[Option, Command] ].
usage(option(Command, value_type(Option, Type, Value))) -->
    { expected(Type, Expected) },
    [ '--~w ~w: ~w expected; see ~w --help'-
      [Option, Value, Expected, Command] ].
usage(option(Command, access_file(File, _))) -->
    [ 'the file ~w cannot be read; see ~w --help'-[File, Command] ].
usage(option(Command, unknown_option(_:Option))) -->
    [ '~w has no option -~w; see ~w --help'-[Command, Option, Command] ].
usage(required(Command, Option)) -->
    [ '~w needs --~w; see ~w --help'-[Command, Option, Command] ].
usage(not_a_term(Text)) -->
    [ 'not a Prolog term: ~w'-[Text] ].
usage(not_in_log(Agent, Log, Names)) -->
    { length(Names, Count) },
    [ 'no events of agent ~w in ~w'-[Agent, Log] ],
    in_log(Names, Count).
usage(empty_log(Log)) -->
    [ 'no events of agents in ~w'-[Log] ].
usage(not_an_id(Agent)) -->
    [ 'not the id of an agent: ~w (with --host ADDRESS a name is enough)'-
      [Agent] ].
usage(no_agent(Name, Host, Agents)) -->
    { names_proposed(Name, Agents, Meant) },
    [ 'no agent ~w in the network of ~w~w (agents --host ~w lists them)'-
      [Name, Host, Meant, Host] ].
usage(several_agents(Name, Ids)) -->
    { atomic_list_concat(Ids, ' or ', Text) },
    [ 'several are named ~w: ~w?'-[Name, Text] ].
usage(no_engine(Host, Fleet)) -->
    [ 'the process of ~w cannot reach the engine of the fleet ~w'-
      [Host, Fleet] ].
usage(not_one_host(Name, [])) -->
    !,
    [ 'no host ~w in the network of the agent'-[Name] ].
usage(not_one_host(Name, Addresses)) -->
    { atomic_list_concat(Addresses, ' or ', Text) },
    [ 'several are named ~w: ~w?'-[Name, Text] ].

expected(nonneg, 'an integer of at least 0') :- !.
expected(natural, 'an integer of at least 1') :- !.
expected(boolean, 'true or false') :- !.
expected(Type, Type).

in_log(Names, Count) -->
    { Count > 0,
      Count =< 20,
      !,
      atomic_list_concat(Names, ', ', Text)
    },
    [ '; agents in it: ~w'-[Text] ].
in_log(_, Count) -->
    { counted(Count, 'other agent', Others) },
    [ ', which has ~w'-[Others] ].
