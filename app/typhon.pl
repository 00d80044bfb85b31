:- module(typhon_app, []).

/** <module> Typhon from the command line

    swipl app/typhon.pl COMMAND ... [options]

`--version` prints the version, `--help` lists the commands, `COMMAND --help`
the options of one.  Expected errors are one line and exit status 1.

The tables of commands.pl define the whole interface; run/3 has one clause
for each command, and uses only predicates of library(typhon).

*Threading*: the main thread only.  A command that runs until it is
stopped waits for a message, which the handlers of signals send.
*/

:- use_module('../prolog/typhon').
:- use_module('../prolog/typhon/kernel/base/error_text', [print_error/2]).
:- use_module('../prolog/typhon/kernel/base/text', [format_shown/2]).
:- use_module('../prolog/typhon/tools/tables',
              [print_agents/2, print_hosts/1, print_tree/1]).
:- use_module('../prolog/typhon/kernel/host/runtime',
              [runtime_acquire/2, runtime_release/1]).
:- use_module('../prolog/typhon/kernel/base/process_setup', [process_setup/0]).
:- use_module('../prolog/typhon/tools/page', [page_export/3, page_serve/2]).
:- use_module(typhon/arguments, [arguments_complete/2]).
:- use_module(typhon/commands, [command/4, footer/2, option/5]).
:- use_module(typhon/diagnose, [diagnose/1]).
:- use_module(typhon/engine_options, [engine_options/3]).
:- use_module(typhon/fleet, [fleet/3]).
:- use_module(typhon/journal, [journal_shown/2]).
:- use_module(typhon/keys, [keys/3, keys_sign_file/3]).
:- use_module(typhon/options, [options_for/3]).
:- use_module(typhon/orders,
              [agent_argument/3, host_now/2, order/3, program_argument/2]).
:- use_module(typhon/picture, [picture/3]).
:- use_module(typhon/serving,
              [and_then/2, run_until_stopped/3, run_until_stopped/4]).
:- use_module(typhon/story, [story/2]).
:- use_module(typhon/usage, [complain/2]).
:- autoload('typhon/bridges/diagnose', [diagnose_bridge/2]).
:- autoload('typhon/fipa/diagnose', [diagnose_fipa/1]).
:- autoload('typhon/nxt/diagnose', [diagnose_nxt/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(main), [argv_options/4, main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(readutil), [read_file_to_terms/3]).

:- initialization(main, main).

:- public main/1.

                /*******************************
                *            OPTIONS           *
                *******************************/

%   The tables in the form of argv_options/4, for the current command.

:- dynamic current_command/1.

opt_type(Option, Option, Type) :-
    current_command(Command),
    option(Command, Option, Type, _, _).

opt_help(help(header), Help) :-
    current_command(Command),
    command(Command, _, _, Help0),
    atomic_list_concat([Command, ': ', Help0], Help).
opt_help(help(usage), Usage) :-
    current_command(Command),
    command(Command, Arguments, _, _),
    atomic_list_concat(['', Command, Arguments, '[options]'], ' ', Usage).
opt_help(Option, Help) :-
    current_command(Command),
    option(Command, Option, _, _, Help).

opt_meta(Option, Meta) :-
    current_command(Command),
    option(Command, Option, _, Meta, _).

                /*******************************
                *             MAIN             *
                *******************************/

main(Argv) :-
    process_setup,
    module_property(typhon_app, file(Script)),
    catch(( arguments_complete(Script, Argv), dispatch(Argv) ),
          error(Formal, Context),
          ( ( command_in(Argv, Command, _) -> true ; Command = none ),
            complain(Command, error(Formal, Context)),
            fail )),
    !,
    halt(0).
main(_) :-
    halt(1).

dispatch(['--version']) :-
    !,
    module_property(typhon_app, file(App)),
    absolute_file_name('../pack.pl', Pack, [relative_to(App)]),
    read_file_to_terms(Pack, Terms, []),
    memberchk(version(Version), Terms),
    print_line(Version).
dispatch(Words) :-
    command_in(Words, Command, Argv),
    command(Command, _, Positional, _),
    !,
    assertz(current_command(Command)),
    (   member(Help, ['--help', '-h']),
        memberchk(Help, Argv)
    ->  command_help
    ;   check_options(Argv, Command),
        parsed(Command, Argv, Arguments, Options),
        check_count(Command, Positional, Arguments),
        with_keys(Options),
        run_connected(Command, Arguments, Options)
    ).
dispatch(Argv) :-
    (   command_in(Argv, Word, _),
        Word \== help
    ->  findall(Command, command(Command, _, _, _), Commands),
        throw(error(typhon_usage(unknown_command(Word, Commands)), _))
    ;   overview
    ).

%   command_in(+Words, -Command, -Argv): options may precede the command.

command_in(Words, Command, Argv) :-
    append(Before, [Command|After], Words),
    \+ sub_atom(Command, 0, _, _, -),
    \+ ( append(_, [Option], Before), takes_value(Option) ),
    !,
    append(Before, After, Argv).

takes_value(Word) :-
    atom_concat('--', Text, Word),
    atomic_list_concat(Parts, -, Text),
    atomic_list_concat(Parts, '_', Option),
    option(_, Option, Type, _, _),
    Type \== boolean.

parsed(Command, Argv, Arguments, Options) :-
    catch(argv_options(typhon_app:Argv, Arguments, Options, []),
          error(Formal, Context),
          not_parsed(Formal, Context, Command)).

not_parsed(opt_error(Problem), _, Command) :-
    !,
    throw(error(typhon_usage(option(Command, Problem)), _)).
not_parsed(syntax_error(_), string(Text0, _), _) :-
    !,
    split_string(Text0, "", " .\n", [Text]),
    throw(error(typhon_usage(not_a_term(Text)), _)).
not_parsed(Formal, Context, _) :-
    throw(error(Formal, Context)).

%   argv_options/4 would end the process itself, without suggestions.

check_options(Argv, Command) :-
    findall(Option, option(Command, Option, _, _, _), Options),
    forall(( member(Word, Argv), long_option(Word, Option) ),
           check_option(Option, Options, Command)).

long_option(Word, Option) :-
    atom_concat('--', Text, Word),
    atomic_list_concat([Name|_], =, Text),
    Name \== '',
    atomic_list_concat(Parts, -, Name),
    atomic_list_concat(Parts, '_', Option).

check_option(Option, Options, _) :-
    ( Plain = Option ; atom_concat(no_, Plain, Option) ),
    memberchk(Plain, Options),
    !.
check_option(Option, Options, Command) :-
    throw(error(typhon_usage(unknown_option(Command, Option, Options)), _)).

%   Sets the keys of the process, for every command that starts an endpoint.

with_keys(Options) :-
    (   option(tls(Directory), Options)
    ->  setenv('TYPHON_TLS', Directory)
    ;   true
    ).

%   A query needs an endpoint for its answer.

run_connected(Command, Arguments, Options) :-
    (   needs_no_endpoint(Command, Options)
    ;   Command == diagnose,
        ( Arguments = [_,_] ; bridge_named(Arguments) )
    ),
    !,
    run(Command, Arguments, Options).
run_connected(keys, [What|Names], Options) :-
    !,
    keys(What, Names, Options).
run_connected(sign, [File], Options) :-
    !,
    required(sign, author(Author), Options),
    option(dir(Directory), Options, keys),
    keys_sign_file(File, Author, Directory).
run_connected(Command, Arguments, Options) :-
    runtime_acquire(client, []),
    and_then(run(Command, Arguments, Options),
             runtime_release(client)).

%   It starts one itself, or reads files alone.

needs_no_endpoint(Command, _) :-
    memberchk(Command, [host, network, check, story, picture]).
needs_no_endpoint(journal, Options) :-
    \+ memberchk(fleet(_), Options).
needs_no_endpoint(log, Options) :-
    ( memberchk(serve(true), Options) ; \+ memberchk(host(_), Options) ).
needs_no_endpoint(page, Options) :-
    memberchk(export(_), Options).

check_count(_, Positional, Arguments) :-
    length(Arguments, Count),
    (   Positional = Min-Max
    ->  between(Min, Max, Count)
    ;   Positional == Count
    ),
    !.
check_count(Command, _, Arguments) :-
    throw(error(typhon_usage(arguments(Command, Arguments)), _)).

overview :-
    called_as(Program),
    format('Usage: ~w COMMAND ... [options]~n~n', [Program]),
    forall(command(Command, Arguments, _, Help),
           overview_line(Command, Arguments, Help)),
    format('~nCOMMAND --help lists the options of a command. Exit status \c
            0: success;~n1: failure, or a negative answer.~n').

%   SWI-Prolog 9.1.18 and later run files in the folder app of a pack by name.

called_as('swipl typhon') :-
    current_prolog_flag(os_argv, [_,typhon|_]),
    !.
called_as('swipl app/typhon.pl').

%   The help follows on the next line if the arguments are long.

overview_line(Command, Arguments, Help) :-
    format(atom(Start), '  ~w ~w', [Command, Arguments]),
    (   atom_length(Start, Length),
        Length < 26
    ->  format('~w~t~26|~w~n', [Start, Help])
    ;   format('~w~n~t~26|~w~n', [Start, Help])
    ).

command_help :-
    phrase(prolog:message(opt_usage(typhon_app)), Lines),
    print_message_lines(user_output, '', Lines),
    nl(user_output),
    current_command(Command),
    forall(footer(Command, Line), format('~w~n', [Line])).

                /*******************************
                *           COMMANDS           *
                *******************************/

run(host, [Name], Options) :-
    options_for(host(Name), Options, HostOptions),
    option(stop_seconds(Seconds), Options, 60),
    run_until_stopped(
        ( joined(Options), host_start(Name, HostOptions) ),
        ( host_property(Name, address(Address)),
          forall(member(link(Other), Options), link(Name, Other)),
          forall(option(mqtt(Broker), Options),
                 mqtt_start(Name, Broker, [wait(false)])),
          print_line(Address)
        ),
        ( drained(Name, Seconds, Options), host_stop(Name) ),
        Seconds).
run(network, [Topology0], Options) :-
    read_argument(Topology0, Topology),
    options_for(network, Options, NetworkOptions),
    run_until_stopped(
        network_start(Topology, Network, NetworkOptions),
        ( network_property(Network, hosts(Addresses)),
          forall(member(Address, Addresses), print_line(Address))
        ),
        network_stop(Network)).
run(create, [Program0], Options) :-
    required(create, host(Host), Options),
    program_argument(Program0, Program),
    options_for(agent, Options, AgentOptions),
    agent_create(Program, Agent, [host(Host)|AgentOptions]),
    print_line(Agent),
    (   option(join(Seconds), Options)
    ->  join(Agent, Seconds)
    ;   true
    ).
run(agents, [], Options) :-
    required(agents, host(Host), Options),
    host_now(Host, _),
    print_agents([Host], full).
run(hosts, [], Options) :-
    required(hosts, host(Host), Options),
    host_now(Host, _),
    print_hosts([Host]).
run(tree, [], Options) :-
    required(tree, host(Host), Options),
    host_now(Host, _),
    print_tree([Host]).
run(send, [Agent0, Message0], Options) :-
    message_argument(Message0, Message),
    agent_argument(Agent0, Options, Agent),
    home_of(Agent, Home),
    option(host(Host), Options, Home),
    remote(Host, call(typhon:agent_send(Agent, Message))).
run(page, [Log], Options) :-
    required(page, export(File), Options),
    page_export(Log, File, []).
run(page, [], Options) :-
    required(page, host(Host), Options),
    host_now(Host, _),
    options_for(page, Options, PageOptions),
    run_until_stopped(
        page_serve(PageOptions, Link),
        print_line(Link),
        page_stop).
run(log, [File], Options) :-
    option(serve(true), Options),
    !,
    options_for(log, Options, LogOptions),
    run_until_stopped(
        log_server_start([file(File), mode(append)|LogOptions], Address),
        print_line(Address),
        log_server_stop(Address)).
run(log, [File], Options) :-
    (   option(host(Host), Options)
    ->  remote(Host, call(typhon:log_events(File, Events)))
    ;   log_events(File, Events)
    ),
    forall(member(Event, Events), print_event(Event)).
run(journal, [Dir], Options) :-
    journal_shown(Dir, Options).
run(story, [Log, Agent], _) :-
    story(Log, Agent).
run(picture, [Log, File], Options) :-
    (   picture(Log, File, Options)
    ->  true
    ;   throw(error(typhon_usage(empty_log(Log)), _))
    ).
run(Command, Arguments, Options) :-
    memberchk(Command, [check, move, dispose, join, remote, stop]),
    !,
    order(Command, Arguments, Options).
run(fleet, [What|Arguments], Options) :-
    fleet(What, Arguments, Options).
run(diagnose, [], _) :-
    diagnose(none).
run(diagnose, [Bridge|Arguments], _) :-
    bridge_named([Bridge|Arguments]),
    !,
    diagnose_bridge(Bridge, Arguments).
run(diagnose, [Address], _) :-
    diagnose(Address).
run(diagnose, [Kind, Port], _) :-
    (   Kind == nxt
    ->  diagnose_nxt(Port)
    ;   Kind == fipa
    ->  diagnose_fipa(Port)
    ;   throw(error(typhon_usage(arguments(diagnose, [Kind,Port])), _))
    ).

joined(Options) :-
    engine_options(host, Options, Engine),
    (   option(fleet(Fleet), Options)
    ->  fleet_join(Fleet, Engine)
    ;   true
    ).

%   Agents of a host of a fleet go elsewhere before it stops, for which a third of
%   Seconds is left.  Those that cannot stay in its journal, if it has one.

drained(Name, Seconds, Options) :-
    (   option(fleet(_), Options)
    ->  Most is Seconds*2/3,
        catch(fleet_drain(Name, [seconds(Most)]), error(Formal, Context),
              print_error(warning, error(Formal, Context)))
    ;   true
    ).

bridge_named([python]).
bridge_named([gpio]).
bridge_named([mqtt]).
bridge_named([mqtt,_]).
bridge_named([ros]).
bridge_named([ros,_]).

join(Agent, Seconds) :-
    agent_join(Agent, Outcome, Seconds),
    print_line(Outcome),
    Outcome == done.

                /*******************************
                *           ARGUMENTS          *
                *******************************/

required(_, Option, Options) :-
    option(Option, Options),
    !.
required(Command, Option, _) :-
    functor(Option, Name, _),
    throw(error(typhon_usage(required(Command, Name)), _)).

read_argument(Text, Term) :-
    catch(term_to_atom(Term, Text),
          error(syntax_error(_), _),
          throw(error(typhon_usage(not_a_term(Text)), _))).

%   Text without quotes that is one variable was meant as text.

message_argument(Text, Message) :-
    catch(term_to_atom(Message, Text), error(syntax_error(_), _), true),
    (   nonvar(Message)
    ->  true
    ;   throw(error(typhon_usage(message(Text)), _))
    ).

home_of(Agent, Home) :-
    sub_atom(Agent, Before, _, _, @),
    !,
    Start is Before+1,
    sub_atom(Agent, Start, _, 0, Home).

                /*******************************
                *            OUTPUT            *
                *******************************/

print_line(Term) :-
    format_shown('~w~n', [Term]),
    flush_output.

print_event(event(Time, Host, Agent, What)) :-
    format_shown('~t~3f~12|  ~w~t~26+ ~w~t~32+ ~p~n',
                 [Time, Host, Agent, What]).
