:- module(test_clusters,
          [ with_slurm/1,               % :Goal
            with_sshd/1                 % :Goal
          ]).

/** <module> A cluster on one machine

Daemons of Slurm and of ssh, with their own ports, keys and files in a
temporary directory, which is removed afterwards.

*Threading*: the main thread.
*/

:- use_module(common).
:- use_module(library(filesex),
              [chmod/2, directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(socket), [gethostname/1]).

:- meta_predicate
    with_slurm(1),
    with_sshd(2).

%   with_daemons(+Commands, :Goal): Commands are lists of a program and its
%   arguments, which stay in the foreground.

:- meta_predicate with_daemons(+, +, 0).

with_daemons([], _, Goal) :-
    call(Goal).
with_daemons([[Program|Arguments]|Commands], Dir, Goal) :-
    file_base_name(Program, Base),
    atomic_list_concat([Dir, /, Base, '.out'], File),
    setup_call_cleanup(
        ( open(File, write, Out),
          process_create(Program, Arguments,
                         [ stdin(null), stdout(stream(Out)),
                           stderr(stream(Out)), process(Pid) ]),
          close(Out) ),
        with_daemons(Commands, Dir, Goal),
        ( catch(process_kill(Pid, term), error(_, _), true),
          process_wait(Pid, _) )).

succeeds(Program, Arguments) :-
    process_create(Program, Arguments,
                   [stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

write_lines(File, Lines) :-
    setup_call_cleanup(
        open(File, write, Out),
        forall(member(Line, Lines), format(Out, '~w~n', [Line])),
        close(Out)).

                /*******************************
                *             SLURM            *
                *******************************/

%!  with_slurm(:Goal) is semidet.
%
%   Call Goal(Dir) while sbatch and the like reach a Slurm of one node.
%
%   @error timeout_error(wait_until, _) if it does not start

with_slurm(Goal) :-
    with_tmp_dir(slurm(Goal)).

slurm(Goal, Dir) :-
    directory_file_path(Dir, 'slurm.conf', Conf),
    free_port(Port),
    free_port(NodePort),
    findall(Line, slurm_line(Dir, Port, NodePort, Line), Lines),
    write_lines(Conf, Lines),
    forall(member(Name, [state, spool]),
           ( directory_file_path(Dir, Name, Below),
             make_directory_path(Below) )),
    munge(Dir, Munge),
    setup_call_cleanup(
        setenv('SLURM_CONF', Conf),
        with_daemons([ Munge, ['/usr/sbin/slurmctld', '-D'],
                       ['/usr/sbin/slurmd', '-D'] ],
                     Dir,
                     ( wait_until(idle, 60),
                       call(Goal, Dir) )),
        unsetenv('SLURM_CONF')).

idle :-
    setup_call_cleanup(
        process_create(path(sinfo), ['--noheader', '--format=%T'],
                       [stdout(pipe(Out)), stderr(null), process(Pid)]),
        read_string(Out, _, Text),
        close(Out)),
    process_wait(Pid, exit(0)),
    sub_string(Text, 0, _, _, "idle"),
    !.

munge(Dir, ['/usr/sbin/munged', '--foreground', '--force', Key|More]) :-
    directory_file_path(Dir, 'munge.key', KeyFile),
    setup_call_cleanup(
        open(KeyFile, write, Out, [type(binary)]),
        forall(between(1, 1024, _),
               ( Byte is random(256), put_byte(Out, Byte) )),
        close(Out)),
    chmod(KeyFile, 0o400),
    chmod(Dir, 0o755),
    atom_concat('--key-file=', KeyFile, Key),
    findall(Argument,
            ( member(Name, [socket, 'pid-file', 'log-file', 'seed-file']),
              format(atom(Argument), '--~w=~w/munge.~w', [Name, Dir, Name]) ),
            More).

slurm_line(Dir, Port, NodePort, Line) :-
    gethostname(Host0),
    atomic_list_concat([Host|_], '.', Host0),
    process_user(User),
    member(Format-Arguments,
           [ 'ClusterName=typhon'-[],
             'SlurmctldHost=~w(127.0.0.1)'-[Host],
             'SlurmUser=~w'-[User],
             'SlurmdUser=~w'-[User],
             'AuthType=auth/munge'-[],
             'AuthInfo=socket=~w/munge.socket'-[Dir],
             'SlurmctldPort=~d'-[Port],
             'SlurmdPort=~d'-[NodePort],
             'StateSaveLocation=~w/state'-[Dir],
             'SlurmdSpoolDir=~w/spool'-[Dir],
             'SlurmctldPidFile=~w/slurmctld.pid'-[Dir],
             'SlurmdPidFile=~w/slurmd.pid'-[Dir],
             'SlurmctldLogFile=~w/slurmctld.log'-[Dir],
             'SlurmdLogFile=~w/slurmd.log'-[Dir],
             'ProctrackType=proctrack/linuxproc'-[],
             'TaskPlugin=task/none'-[],
             'SelectType=select/cons_tres'-[],
             'SelectTypeParameters=CR_CPU'-[],
             'JobAcctGatherType=jobacct_gather/none'-[],
             'AccountingStorageType=accounting_storage/none'-[],
             'MpiDefault=none'-[],
             'SlurmdParameters=config_overrides'-[],
             'NodeName=~w NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN'-[Host],
             'PartitionName=all Nodes=ALL Default=YES State=UP'-[] ]),
    format(atom(Line), Format, Arguments).

process_user(User) :-
    setup_call_cleanup(
        process_create(path(id), ['-un'], [stdout(pipe(Out))]),
        read_string(Out, " \n", " \n", _, Text),
        close(Out)),
    atom_string(User, Text).

                /*******************************
                *              SSH             *
                *******************************/

%!  with_sshd(:Goal) is semidet.
%
%   Call Goal(Dir, Ssh) while an ssh daemon of this machine runs: Ssh is the
%   command that logs in, with its options.

with_sshd(Goal) :-
    with_tmp_dir(sshd(Goal)).

sshd(Goal, Dir) :-
    make_directory_path('/run/sshd'),
    free_port(Port),
    findall(Key, ( member(Name, [host, user]), key(Dir, Name, Key) ),
            [HostKey, UserKey]),
    atom_concat(UserKey, '.pub', Public),
    directory_file_path(Dir, sshd_config, Conf),
    findall(Line,
            ( member(Format-Arguments,
                     [ 'Port ~d'-[Port], 'ListenAddress 127.0.0.1'-[],
                       'HostKey ~w'-[HostKey],
                       'AuthorizedKeysFile ~w'-[Public],
                       'StrictModes no'-[], 'UsePAM no'-[],
                       'PidFile none'-[], 'PermitRootLogin yes'-[] ]),
              format(atom(Line), Format, Arguments) ),
            Lines),
    write_lines(Conf, Lines),
    format(atom(Ssh), 'ssh -p ~d -i ~w -o BatchMode=yes -o LogLevel=ERROR \c
-o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null',
           [Port, UserKey]),
    format(atom(Try), '~w 127.0.0.1 true', [Ssh]),
    with_daemons([['/usr/sbin/sshd', '-D', '-e', '-f', Conf]], Dir,
                 ( wait_until(succeeds(path(sh), ['-c', Try]), 60),
                   call(Goal, Dir, Ssh) )).

key(Dir, Name, File) :-
    directory_file_path(Dir, Name, File),
    succeeds(path('ssh-keygen'), ['-q', '-t', ed25519, '-N', '', '-f', File]).
