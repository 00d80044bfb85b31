:- module(typhon_slurm,
          [ slurm_nodes/3,              % +Network, +Options, -Machines
            slurm_release/1             % +Network
          ]).
:- use_module(library(lists), [append/2, member/2, nth0/3]).
:- use_module(library(option), [option/3]).
:- autoload(library(process),
              [process_kill/2, process_wait/2, process_wait/3]).
:- use_module(library(settings), [setting/2]).
:- use_module('../kernel/base/prolog_faults', [spawn/3]).

/** <module> Nodes of a cluster from Slurm

salloc holds the nodes of a network as long as its command runs, which reads an
input that this process keeps open: the end of this process releases the nodes,
however it ends.

*Threading*: the thread that starts or stops the network.
*/

:- multifile
    typhon_options:declared/4.

:- dynamic
    allocation/3.               % Network, Pid of salloc, its streams

typhon_options:declared(slurm_option, nodes(N), positive_integer, N).
typhon_options:declared(slurm_option, partition(P), atom, P).
typhon_options:declared(slurm_option, time(T), atomic, T).
typhon_options:declared(slurm_option, more(Args), list(atomic), Args).
typhon_options:declared(slurm_option, swipl(P), atom, P).
typhon_options:declared(slurm_option, node(File), atom, File).

%!  slurm_nodes(+Network, +Options, -Machines:list) is det.
%
%   Machines are the nodes that Slurm allocates: terms slurm(Job, I, Node,
%   Options).
%
%   @error resource_error(nodes(N)), with what Slurm says

slurm_nodes(Network, Options, Machines) :-
    salloc_args(Options, Args),
    spawn(path(env), ['-u', 'TYPHON_COOKIE', salloc|Args],
          [ stdin(pipe(In)), stdout(pipe(Out)), stderr(pipe(Err)),
            process(Pid), detached(true) ]),
    assertz(allocation(Network, Pid, [In, Out, Err])),
    read_string(Out, "\n", "", End, Line),
    (   End == -1
    ->  refused(Network, Options, Err)
    ;   split_string(Line, " ", " ", [Job|Nodes]),
        findall(slurm(Job, I, Node, Options),
                ( nth0(I, Nodes, Text), atom_string(Node, Text) ),
                Machines)
    ).

%   The time in the queue is limited like that of the start.

salloc_args(Options, Args) :-
    setting(typhon_processes:start_seconds, Seconds),
    Most is max(1, ceiling(Seconds)),
    option(nodes(N), Options, 1),
    option(more(More), Options, []),
    findall(Arg,
            ( member(Option, [nodes(N), immediate(Most)|Options]),
              Option =.. [Name, Value],
              memberchk(Name, [nodes, immediate, partition, time]),
              format(atom(Arg), '--~w=~w', [Name, Value]) ),
            Own),
    append([ ['--quiet'|Own], More,
             [ sh, '-c', 'echo $SLURM_JOB_ID \c
                          $(scontrol show hostnames $SLURM_JOB_NODELIST); \c
                          exec cat >/dev/null' ] ],
           Args).

refused(Network, Options, Err) :-
    allocation(Network, Pid, _),
    read_string(Err, _, Text),
    process_wait(Pid, Status),
    why(Status, Text, Why),
    option(nodes(N), Options, 1),
    throw(error(resource_error(nodes(N)), context(_, Why))).

why(exit(127), _, 'install the commands of Slurm here: there is no salloc') :-
    !.
why(_, Text, Why) :-
    split_string(Text, "\n", "\n", [First|_]),
    ( string_concat("salloc: error: ", Said, First) -> true ; Said = First ),
    format(string(Why), 'Slurm: ~w; see sinfo and squeue, more time is the \c
                         setting typhon_processes:start_seconds', [Said]).

%!  slurm_release(+Network) is det.

slurm_release(Network) :-
    retract(allocation(Network, Pid, Streams)),
    !,
    forall(member(Stream, Streams), close(Stream, [force(true)])),
    catch(process_wait(Pid, Status, [timeout(10)]),
          error(existence_error(_, _), _),      % refused
          true),
    (   Status == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _)
    ;   true
    ).
slurm_release(_).
