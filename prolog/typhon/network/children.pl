:- module(typhon_children,
          [ child_start/6,              % +Tag, +Machine, +At,
                                        % +Options, :OnEvent, -Child
            child_secret/1,             % -Secret
            child_close/1,              % +Child
            child_kill/1,               % +Child
            child_release/1             % +Child
          ]).
:- use_module(library(debug), [debug/3]).
:- autoload(library(process), [process_kill/2, process_wait/2]).
:- autoload(library(readutil), [read_line_to_string/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/prolog_faults', [spawn/3]).
:- use_module('../kernel/wire', [cookie/1, random_hex/2]).
:- use_module('../options/keys', [own_keys/1]).
:- use_module(child_output, [output_line/2]).
:- use_module(machines, [machine_command/5, machine_kill/3, machine_node/3]).
:- use_module(node_program, [node_file/1, node_flags/1, node_program/2]).

/** <module> Child processes that run the hosts of a network

A child runs node_process.pl, on this machine or another, see module
`machines`. It
reads its parameters from one line of its standard input. The cookie is one of
them, so that no argument list and no environment shows it. The child
prints the address of its endpoint in one line on its standard output. This
process prints the later output of the child, see module `child_output`. A child
that cannot start prints the reason in such a line, and ends.

The standard input of a child stays open as long as the child is needed. The
end of input orders the child to stop. It also occurs when this process dies.

Each child leads a session of its own, so the interrupt key of a terminal
interrupts the query of this process, not the network.

*Threading*: one thread per child reads its output and waits for its end. It
calls OnEvent with up(Tag, Endpoint, Pid) when the child is ready, where Pid is
the process id on the machine of the child, with failed(Tag, Error) if the child
cannot start, and with down(Tag, Status) when it has ended. The thread is no
`server`, as it waits for a stream.
*/

:- meta_predicate child_start(+, +, +, +, 1, -).

:- public
    stop_reading/0.             % goal of a signal

:- multifile
    prolog:message//1.

:- setting(stop_seconds, number, 5,
           "Seconds for a child to end in order before it is killed").

:- dynamic
    secret/1.                   % of this process, for its children

%!  child_start(+Tag, +Machine, +At, +Options, :OnEvent, -Child) is det.
%
%   Start a child on Machine, see module `machines`. For a target of ssh, or
%   machine(Target, Options), the options are
%
%     - swipl(Program): default `swipl`
%     - node(File): path of node_process.pl on that machine, default as here
%     - bind(Interface): interface at which the child listens, default the host
%       of Target
%     - advertise(Address): default Interface, as of host_start/2
%     - more(Args): options of ssh
%
%   A local child listens as At, at(Interface, Advertised), says. Options are
%   for the child: port(Port), at which it listens, journal(Directory, How), see
%   doc/journal.md, on its machine, hosts(Options), which override the options
%   of hosts in the journal, and fleet(Fleet, Joins), which it joins.
%
%   @error errors of machine_node/3, and of process_create/3

child_start(Tag, Machine, At0, Options, OnEvent,
            child(Pid, In, Thread)) :-
    machine_node(Machine, At0, At),
    command(Machine, Program, Args),
    cookie(Cookie),
    keys(Keys),
    setting(stop_seconds, Seconds),
    spawn(Program, Args,
          [ stdin(pipe(In)), stdout(pipe(Out)), process(Pid),
            detached(true)
          ]),
    follower_alias(Tag, Alias),
    thread_create(follow(Tag, Machine, Pid, Out, OnEvent), Thread,
                  [alias(Alias)]),
    debug(typhon(network), 'process ~w of ~w is started: ~w, ~p',
          [Pid, Tag, Program, Args]),
    child_secret(Secret),
    catch(send_term(In, node(Cookie, Secret, At, Seconds, Keys, Options)),
          error(io_error(_, _), _),
          true).                % the child has ended: down(Tag, _) follows

%!  child_secret(-Secret) is det.
%
%   Secret goes with each order to a child of this process.

child_secret(Secret) :-
    with_mutex(typhon_children, secret_made(Secret)).

secret_made(Secret) :-
    secret(Secret),
    !.
secret_made(Secret) :-
    random_hex(32, Secret),
    assertz(secret(Secret)).

%   A process with TLS can connect only to others with TLS.

keys(Keys) :-
    (   own_keys(Directory)
    ->  Keys = keys(Directory)
    ;   Keys = none
    ).

%   Tags need not be unique, and may be any term: an alias has a number.

follower_alias(Tag, Alias) :-
    flag(typhon_follower, N, N+1),
    format(atom(Alias), 'typhon_follower_~w_~d', [Tag, N]).

send_term(In, Term) :-
    set_stream(In, encoding(utf8)),
    write_term(In, Term,                % with the syntax of system, not of user
               [ quoted(true), ignore_ops(true), numbervars(false),
                 module(system), fullstop(true), nl(true) ]),
    flush_output(In).

command(local, Program, Args) :-
    !,
    node_program(Program, Args).
command(Machine, Program, Args) :-
    node_flags(Flags),
    node_file(File),
    machine_command(Machine, Flags, File, Program, Args).

                /*******************************
                *          FOLLOWING           *
                *******************************/

follow(Tag, Machine, Pid, Out, OnEvent) :-
    set_stream(Out, encoding(utf8)),
    nb_setval(typhon_there, none),
    catch(( nb_setval(typhon_reading, true),
            lines(Tag, Out, OnEvent),
            nb_setval(typhon_reading, false) ),
          stop_reading,
          true),
    close(Out),
    process_wait(Pid, Status),
    nb_getval(typhon_there, There),
    machine_kill(Machine, Status, There),
    call(OnEvent, down(Tag, Status)).

lines(Tag, Out, OnEvent) :-
    read_line_to_string(Out, Line),
    (   Line == end_of_file
    ->  true
    ;   line(Line, Tag, OnEvent),
        lines(Tag, Out, OnEvent)
    ).

line(Line, Tag, OnEvent) :-
    (   split_string(Line, " ", "", ["typhon_node_process", Endpoint0, Pid0])
    ->  atom_string(Endpoint, Endpoint0),
        number_string(Pid, Pid0),
        nb_setval(typhon_there, Pid),
        call(OnEvent, up(Tag, Endpoint, Pid))
    ;   string_concat("typhon_node_process_error ", Text, Line),
        catch(term_string(Error, Text), error(_, _), fail)
    ->  call(OnEvent, failed(Tag, Error))
    ;   output_line(Tag, Line)
    ).

%!  child_close(+Child) is det.
%
%   Order the child to stop: close its standard input.

child_close(child(_, In, _)) :-
    catch(close(In, [force(true)]), error(Formal, _),
          debug(typhon(network), 'closing a child: ~p', [Formal])).

%!  child_kill(+Child) is det.
%
%   Kill the process of Child at once. The thread stops reading the output,
%   which another process, such as a program that the child started, may hold
%   open.

child_kill(child(Pid, _, Thread)) :-
    catch(process_kill(Pid, kill), error(existence_error(_, _), _), true),
    catch(thread_signal(Thread, typhon_children:stop_reading),
          error(existence_error(_, _), _), true).

%   The signal may arrive before the thread reads, or after it has read: the
%   output may end first, or another signal arrive. The thread catches the
%   exception only while it reads.

stop_reading :-
    (   nb_current(typhon_reading, true)
    ->  nb_setval(typhon_reading, false),
        throw(stop_reading)
    ;   true
    ).

%!  child_release(+Child) is det.

child_release(child(_, _, Thread)) :-
    thread_join(Thread, Status),
    (   Status == true
    ->  true
    ;   print_message(warning, typhon(child_thread(Status)))
    ).

prolog:message(typhon(child_thread(Status))) -->
    [ 'The thread that followed a process ended with ~p'-[Status] ].
