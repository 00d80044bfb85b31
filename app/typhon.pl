:- module(typhon_app, []).

/** <module> Typhon from the command line

    swipl app/typhon.pl COMMAND ... [options]

`--help` lists the commands, `COMMAND --help` the options of one.  Expected
errors are one line and exit status 1.

The whole interface stands in the tables of commands.pl; run/3 has one
clause for each command, and does nothing that a program could not do with
library(typhon).

*Threading*: the main thread only.  A command that runs until it is told to
stop waits for a message, which the handlers of SIGINT and SIGTERM send.
*/

:- use_module('../prolog/typhon').
:- use_module('../prolog/typhon/base/names',
              [names_listed/2, names_proposed/3]).
:- use_module('../prolog/typhon/network/log', [log_server_stop/1]).
:- use_module('../prolog/typhon/people/tables',
              [print_agents/2, print_hosts/1]).
:- use_module('../prolog/typhon/host/runtime',
              [runtime_acquire/2, runtime_release/1]).
:- use_module('../prolog/typhon/people/happenings', [short_name/2]).
:- use_module('../prolog/typhon/page', [page_export/3, page_serve/2]).
:- use_module(commands, [command/4, footer/2, option/5]).
:- use_module(diagnose, [diagnose/1]).
:- use_module(diagnose_fipa, [diagnose_fipa/1]).
:- use_module(diagnose_bridges, [diagnose_bridge/2]).
:- use_module(diagnose_nxt, [diagnose_nxt/1]).
:- use_module(journal, [journal_shown/2]).
:- use_module(keys, [keys/3, keys_sign_file/3]).
:- use_module(orders,
              [agent_argument/3, host_now/2, order/3, program_argument/2]).
:- use_module(picture, [picture/3]).
:- use_module(story, [story/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [argv_options/4, main/0]).
:- use_module(library(option), [option/2, option/3]).

:- initialization(main, main).

:- public main/1.

                /*******************************
                *            OPTIONS           *
                *******************************/

%   The tables as argv_options/4 wants them, for the command at hand.

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
    catch(dispatch(Argv), error(Formal, Context),
          complain(error(Formal, Context))),
    !,
    halt(0).
main(_) :-
    halt(1).

complain(Error) :-
    (   Error = error(Formal, _),
        hint(Formal, Hint)
    ->  print_message(error, typhon_hint(Error, Hint))
    ;   print_message(error, Error)
    ),
    halt(1).

%   What to try next.

hint(host_unreachable(Host), Hint) :-
    format(atom(Hint), 'diagnose ~w tells why', [Host]).
hint(connection_lost(Host), Hint) :-
    format(atom(Hint), 'diagnose ~w tells why', [Host]).
hint(existence_error(agent, _), 'agents --host ADDRESS tells who is there').
hint(existence_error(host, _), 'hosts --host ADDRESS tells which there are').
hint(domain_error(topology, _), 'network --help tells the shapes').
hint(existence_error(source_sink, _), 'a file, or a term as agents(census)').

dispatch([Command|Argv]) :-
    command(Command, _, Positional, _),
    !,
    assertz(current_command(Command)),
    (   member(Help, ['--help', '-h']),
        memberchk(Help, Argv)
    ->  command_help
    ;   check_options(Argv, Command),
        argv_options(typhon_app:Argv, Arguments, Options, []),
        check_count(Command, Positional, Arguments),
        with_keys(Options),
        run_connected(Command, Arguments, Options)
    ).
dispatch(Argv) :-
    (   Argv = [Word|_],
        \+ memberchk(Word, ['--help', '-h', help])
    ->  findall(Command, command(Command, _, _, _), Commands),
        throw(error(typhon_usage(unknown_command(Word, Commands)), _))
    ;   overview
    ).

%   argv_options/4 would end the process itself, and propose nothing.

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

%   For whatever starts the endpoint.

with_keys(Options) :-
    (   option(tls(Directory), Options)
    ->  setenv('TYPHON_TLS', Directory)
    ;   true
    ).

%   Who asks needs an endpoint for the answer.

run_connected(Command, Arguments, Options) :-
    (   serves(Command, Options)
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

serves(host, _).
serves(network, _).
serves(journal, _).
serves(log, Options) :-
    memberchk(serve(true), Options).

check_count(_, Positional, Arguments) :-
    length(Arguments, Count),
    (   Positional = Min-Max
    ->  between(Min, Max, Count)
    ;   Positional == Count
    ),
    !.
check_count(Command, _, _) :-
    throw(error(typhon_usage(arguments(Command)), _)).

overview :-
    format('Usage: swipl app/typhon.pl COMMAND ... [options]~n~n'),
    forall(command(Command, Arguments, _, Help),
           format('  ~w ~w~t~26|~w~n', [Command, Arguments, Help])),
    format('~nCOMMAND --help tells the options of a command. Exit status: \c
            0, it was done;~n1, it was not, or the answer is no.~n').

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
    findall(Option, host_option(Options, Option), HostOptions),
    until_told_to_stop(
        host_start(Name, HostOptions),
        ( host_property(Name, address(Address)),
          forall(member(link(Other), Options), link(Name, Other)),
          print_line(Address)
        ),
        host_stop(Name)).
run(network, [Topology0], Options) :-
    read_argument(Topology0, Topology),
    findall(Option, network_option(Options, Option), NetworkOptions),
    until_told_to_stop(
        network_start(Topology, Network, NetworkOptions),
        ( network_property(Network, hosts(Addresses)),
          forall(member(Address, Addresses), print_line(Address))
        ),
        network_stop(Network)).
run(create, [Program0], Options) :-
    required(create, host(Host), Options),
    program_argument(Program0, Program),
    findall(Option, agent_option(Options, Option), AgentOptions),
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
run(send, [Agent0, Message0], Options) :-
    read_argument(Message0, Message),
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
    findall(Option, page_option(Options, Option), PageOptions),
    until_told_to_stop(
        page_serve(PageOptions, Link),
        print_line(Link),
        page_stop).
run(log, [File], Options) :-
    option(serve(true), Options),
    !,
    findall(Option, log_option(Options, Option), LogOptions),
    until_told_to_stop(
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
    (   story(Log, Agent)
    ->  true
    ;   throw(error(typhon_usage(not_in_log(Agent, Log)), _))
    ).
run(picture, [Log, File], Options) :-
    (   picture(Log, File, Options)
    ->  true
    ;   throw(error(typhon_usage(empty_log(Log)), _))
    ).
run(Command, Arguments, Options) :-
    memberchk(Command, [check, move, dispose, join, remote, stop]),
    !,
    order(Command, Arguments, Options).
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
    ;   throw(error(typhon_usage(arguments(diagnose)), _))
    ).

page_option(Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [host, port, bind, read_only]).

bridge_named([python]).
bridge_named([mqtt]).
bridge_named([mqtt,_]).
bridge_named([ros]).
bridge_named([ros,_]).

host_option(Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [port, bind, capacity, journal, sync]).
host_option(Options, Option) :-
    log_events_option(Options, Option).
host_option(Options, tokens(Tokens)) :-
    comma_list(tokens(Text), Options, Text, Tokens).
host_option(Options, authors(Authors)) :-
    comma_list(authors(Text), Options, Text, Authors).
host_option(Options, consult(Files)) :-
    findall(File, member(consult(File), Options), Files),
    Files \== [].

network_option(Options, machines(Machines)) :-
    comma_list(machines(Text), Options, Text, Machines).
network_option(Options, Option) :-
    member(Option, Options),
    Option =.. [Name|_],
    \+ memberchk(Name, [machines, log, events, tls]).
network_option(Options, Option) :-
    log_events_option(Options, Option).

log_events_option(Options, Option) :-
    option(log(Log), Options),
    (   comma_list(events(Text), Options, Text, Kinds)
    ->  Option = log(Log, Kinds)
    ;   Option = log(Log)
    ).

agent_option(Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [name, lifetime, static]).
agent_option(Options, tokens(Tokens)) :-
    comma_list(tokens(Text), Options, Text, Tokens).
agent_option(Options, payloads(Payloads)) :-
    findall(Payload,
            ( member(payload(Text), Options),
              program_argument(Text, Payload)
            ),
            Payloads),
    Payloads \== [].
agent_option(Options, facts(Facts)) :-
    findall(Fact, member(fact(Fact), Options), Facts),
    Facts \== [].

log_option(Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [port, bind]).

                /*******************************
                *        STOP AND WAIT         *
                *******************************/

:- meta_predicate until_told_to_stop(0, 0, 0).

%   All is done in a thread of its own.  While the main thread creates
%   threads, signals reach one of those, and are lost.

until_told_to_stop(Start, Report, Stop) :-
    on_signal(term, _, typhon_app:told_to_stop),
    on_signal(int, _, typhon_app:told_to_stop),
    thread_create(serve(Start, Report, Stop), Server),
    thread_send_message(Server, start),
    thread_get_message(serving(Event)),
    (   Event == told_to_stop
    ->  thread_send_message(Server, stop)
    ;   true
    ),
    thread_join(Server, Status),
    (   Status = exception(Error)
    ->  throw(Error)
    ;   Status == true
    ).

told_to_stop(_Signal) :-
    thread_send_message(main, serving(told_to_stop)).

serve(Start, Report, Stop) :-
    call_cleanup(( thread_get_message(start),
                   call(Start),
                   and_then(( once(Report),
                              thread_get_message(stop)
                            ), Stop)
                 ),
                 thread_send_message(main, serving(ended))).

%   setup_call_cleanup/3 will not do: a wait with a deadline goes on for ever
%   in its cleanup handler when a signal is pending.

:- meta_predicate and_then(0, 0).

and_then(Goal, Finally) :-
    catch(( call(Goal) -> Result = true ; Result = fail ),
          error(Formal, Context),
          Result = throw(error(Formal, Context))),
    call(Finally),
    call(Result).

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

comma_list(Option, Options, Text, Parts) :-
    option(Option, Options),
    atomic_list_concat(Parts, ',', Text).

home_of(Agent, Home) :-
    sub_atom(Agent, Before, _, _, @),
    !,
    Start is Before+1,
    sub_atom(Agent, Start, _, 0, Home).

                /*******************************
                *            OUTPUT            *
                *******************************/

print_line(Term) :-
    format('~w~n', [Term]),
    flush_output.

print_event(event(Time, Host, Agent, What)) :-
    format('~t~3f~12|  ~w~t~26+ ~w~t~32+ ~p~n', [Time, Host, Agent, What]).

:- multifile
    prolog:error_message//1,
    prolog:message//1.

prolog:message(typhon_hint(Error, Hint)) -->
    '$messages':translate_message(Error),
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
usage(arguments(Command)) -->
    { command(Command, Arguments, _, _) },
    [ '~w takes ~w; see ~w --help'-[Command, Arguments, Command] ].
usage(required(Command, Option)) -->
    [ '~w needs --~w; see ~w --help'-[Command, Option, Command] ].
usage(not_a_term(Text)) -->
    [ 'not a Prolog term: ~w'-[Text] ].
usage(not_in_log(Agent, Log)) -->
    { log_events(Log, Events),
      findall(Short,
              ( member(event(_, _, Id, _), Events), short_name(Id, Short) ),
              Names0),
      sort(Names0, Names),
      length(Names, Count)
    },
    [ 'nothing of an agent ~w in ~w'-[Agent, Log] ],
    in_log(Names, Count).
usage(empty_log(Log)) -->
    [ 'no events of agents in ~w'-[Log] ].
usage(not_an_id(Agent)) -->
    [ 'not the id of an agent: ~w (with --host ADDRESS a name is enough)'-
      [Agent] ].
usage(no_agent(Name, Host)) -->
    [ 'no agent ~w in the network of ~w (agents --host ~w lists them)'-
      [Name, Host, Host] ].
usage(several_agents(Name, Ids)) -->
    { atomic_list_concat(Ids, ' or ', Text) },
    [ 'which ~w is meant: ~w?'-[Name, Text] ].
usage(not_one_host(Name, [])) -->
    !,
    [ 'no host ~w in the network of the agent'-[Name] ].
usage(not_one_host(Name, Addresses)) -->
    { atomic_list_concat(Addresses, ' or ', Text) },
    [ 'which ~w is meant: ~w?'-[Name, Text] ].

in_log(Names, Count) -->
    { Count > 0,
      Count =< 20,
      !,
      atomic_list_concat(Names, ', ', Text)
    },
    [ '; it knows ~w'-[Text] ].
in_log(_, Count) -->
    [ ', which knows ~D others'-[Count] ].
