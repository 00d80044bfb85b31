:- module(typhon_machines,
          [ machine_checked/1,          % +Machine
            machine_node/3,             % +Machine, +At0, -At
            machine_command/5,          % +Machine, +Flags, +File, -Program,
                                        % -Args
            machine_kill/3,             % +Machine, +Status, +Pid
            machine_error/3             % +Machine, +Error0, -Error
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [domain_error/2, must_be/2, type_error/2]).
:- use_module(library(lists), [append/3, last/2]).
:- use_module(library(option), [option/3]).
:- autoload(library(process),
              [process_kill/2, process_wait/2, process_wait/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/options', [check_options/2]).
:- use_module('../kernel/base/prolog_faults', [spawn/3]).
:- use_module('../kernel/base/text', [shell_word/2]).

/** <module> The machines that run the processes of a network

A machine is `local`, a target of ssh, machine(Target, Options), ssh(M) for one
of these in start(ssh(Machines)), or slurm(Job, I, Node, Options): the I-th node
of an allocation, see module `slurm`.  A process of a machine is a child of this
process: the program that reaches the machine carries its input and output.

*Threading*: any thread.
*/

:- multifile
    typhon_options:declared/4.

:- setting(typhon_children:ssh, atom, ssh,
           "The program that reaches other machines").

typhon_options:declared(machine_option, bind(X), atom, X).
typhon_options:declared(machine_option, advertise(X), atom, X).
typhon_options:declared(machine_option, swipl(X), atom, X).
typhon_options:declared(machine_option, node(X), atom, X).
typhon_options:declared(machine_option, more(X), list(atomic), X).

%   reached(+Machine, -By, -Options): By is ssh(Target) or slurm(Job, I, Node).

reached(slurm(Job, I, Node, Options), slurm(Job, I, Node), Options) :-
    !.
reached(ssh(Machine), By, Options) :-
    !,
    reached(Machine, By, Options).
reached(machine(Target, Options), ssh(Target), Options) :-
    !.
reached(Target, ssh(Target), []) :-
    atom(Target).

%!  machine_checked(+Machine) is det.
%
%   @error type_error(machine, Machine), domain_error(machine_option, Option),
%   domain_error(machine, Target) if Target names no host, or ssh would take it
%   for one of its options

machine_checked(Machine) :-
    (   nonvar(Machine),
        reached(Machine, ssh(Target), Options)
    ->  must_be(atom, Target),
        check_options(machine_option, Options),
        check_target(Target)
    ;   type_error(machine, Machine)
    ).

check_target(Target) :-
    target_host(Target, Host),
    (   Host \== '',
        \+ sub_atom(Target, 0, _, _, -)
    ->  true
    ;   domain_error(machine, Target)
    ).

target_host(Target, Host) :-
    atomic_list_concat(Parts, @, Target),
    last(Parts, Host).

%!  machine_node(+Machine, +At0, -At) is det.
%
%   A process on Machine listens as At, at(Interface, Advertised), says; At0 is
%   that of this machine.  The name of a node of Slurm may stand for a loopback
%   address there, so its processes listen at all its interfaces.

machine_node(local, At, At) :-
    !.
machine_node(slurm(_, _, Node, _), _, at('0.0.0.0', Node)) :-
    !.
machine_node(Machine, _, at(Interface, Advertised)) :-
    machine_checked(Machine),
    reached(Machine, ssh(Target), Options),
    target_host(Target, Host),
    option(bind(Interface), Options, Host),
    option(advertise(Advertised), Options, none).

%!  machine_command(+Machine, +Flags:list, +File, -Program, -Args) is det.
%
%   Program with Args runs `swipl Flags File` on Machine, which is not `local`.
%   File is the path here, if Machine has no other.

machine_command(Machine, Flags, Here, Program, Args) :-
    reached(Machine, By, Options),
    option(swipl(Swipl), Options, swipl),
    option(node(File0), Options, Here),
    named_now(File0, File),
    append([Swipl|Flags], [File], Words),
    on_machine(By, Options, Words, Program, Args).

%   on_machine(+By, +Options, +Words, -Program, -Args): Program with Args runs
%   the command Words on a machine.  ssh passes its arguments to a shell there.
%   srun would pass the environment over the network.

on_machine(ssh(Target), Options, Words, Program, Args) :-
    setting(typhon_children:ssh, Ssh),
    (   is_absolute_file_name(Ssh)
    ->  Program = Ssh
    ;   Program = path(Ssh)
    ),
    option(more(More), Options, []),
    maplist(shell_word, Words, Command),
    append(More, [Target|Command], Args).
on_machine(slurm(Job, I, _), _, Words, path(env), Args) :-
    append([ '-u', 'TYPHON_COOKIE', srun, '--quiet', '--jobid', Job,
             '--overlap', '--nodes=1', '--ntasks=1', '--relative', I ],
           Words, Args).

%   Options may name node_process.pl by its old name, carrier.pl.

named_now(File0, File) :-
    (   atom_concat(Dir, '/carrier.pl', File0)
    ->  atom_concat(Dir, '/node_process.pl', File)
    ;   File = File0
    ).

%!  machine_kill(+Machine, +Status, +Pid) is det.
%
%   The program that reached the process Pid on Machine has ended with Status.
%   Kill the process, if Status leaves open whether it has ended, too: it may
%   hang, and hold its port.  The number may be that of another process by now.

machine_kill(Machine, Status, Pid) :-
    integer(Pid),
    Machine \== local,
    reached(Machine, By, Options),
    left_open(By, Status),
    !,
    format(atom(Script), 'case $(ps -o args= -p ~d) in \c
                          *node_main*) kill -9 ~d; esac', [Pid, Pid]),
    on_machine(By, Options, [sh, '-c', Script], Program, Args),
    catch(runs_at_most(5, Program, Args), error(_, _), true).
machine_kill(_, _, _).

left_open(ssh(_), exit(255)).
left_open(_, killed(_)).

runs_at_most(Seconds, Program, Args) :-
    spawn(Program, Args,
          [stdin(null), stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, Status, [timeout(Seconds)]),
    (   Status == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _)
    ;   true
    ).

                /*******************************
                *            ERRORS            *
                *******************************/

%!  machine_error(+Machine, +Error0, -Error) is det.
%
%   Error is Error0 of the start of a process, with the name of a Machine of
%   start(How), and how to find the cause.

machine_error(Machine, error(Formal, Context),
              error(Formal, context(_, Text))) :-
    named(Machine, By, Name),
    !,
    (   ( remedy(By, Formal, Remedy) ; remark(Context, Remedy) )
    ->  format(string(Text), 'on ~w: ~w', [Name, Remedy])
    ;   format(string(Text), 'on ~w', [Name])
    ).
machine_error(_, Error, Error).

named(ssh(Machine), ssh(Target), Target) :-
    reached(Machine, ssh(Target), _).
named(slurm(Job, I, Node, _), slurm(Job, I, Node), Node).

remark(Context, Text) :-
    subsumes_term(context(_, _), Context),
    Context = context(_, Text),
    atomic(Text).

remedy(ssh(Target), system_error(process_ended(exit(255))), Text) :-
    format(atom(Text), 'ssh cannot log in, try: ssh ~w true', [Target]).
remedy(ssh(_), system_error(process_ended(exit(127))),
       'swipl is not found there: install SWI-Prolog, or write \c
        machine(Target, [swipl(Path)])').
remedy(slurm(_, _, _), system_error(process_ended(exit(2))),
       'swipl is not found there: install SWI-Prolog, or write \c
        slurm([swipl(Path)|_])').
remedy(_, system_error(process_ended(_)),
       'Typhon does not start there: this version must be at the same path, \c
        or be named by the option node(File)').
remedy(ssh(Target), timeout_error(start, _), Text) :-
    format(atom(Text), 'it does not answer, try: ssh ~w true', [Target]).
remedy(slurm(_, _, _), timeout_error(start, _),
       'it does not answer, see sinfo').
remedy(ssh(_), existence_error(source_sink, _),
       'install ssh here, or name it by the setting typhon_children:ssh').
