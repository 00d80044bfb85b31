:- module(bench_sampled,
          [ patient_threads/0,
            thread_times/1,             % -Times
            sampling_begin/1,           % +Role
            sampling_end/2              % -Times, -Spent
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [max_member/2, member/2]).
:- use_module(library(process), [process_create/3]).
:- use_module(library(yall)).

/** <module> Processor time of threads of this process, by module

The profiler of SWI-Prolog samples one thread of a process at a time. A signal
starts and stops it in that thread. It samples every five
milliseconds of real time: with processor time it would sample when any thread
of the process works, and often find its own thread waiting. So work inside
the predicates in which a thread waits is not visible: it is the remaining
processor time. A thread that waits for a processor or a mutex counts as
working. A thread that wakes others would look expensive, because these
preempt it; patient_threads/0 prevents this.

Time in the system and its libraries counts for the module that called them,
garbage collection separately. The profiler knows its own overhead, which is
excluded. A thread can be sampled only once: the data of the profiler must not
be freed while a sample may be under way, and while frames of the thread still
refer to it.

*Threading*: one thread at a time calls these predicates.
*/

:- dynamic
    sampled/2.                  % Thread, Cpu: its processor time at the start

%!  patient_threads is det.
%
%   Workers and readers do not preempt any more when they are woken: a
%   Linux policy for batch work. The main thread, which samples, still does.

patient_threads :-
    forall(( member(Role, [worker,reader]), thread_time(Role, Thread, _) ),
           patient(Thread)).

patient(Thread) :-
    thread_property(Thread, system_thread_id(Id)),
    process_create(path(chrt), ['--batch', '--pid', 0, Id], []).

%!  thread_times(-Times) is det.
%
%   Times are Role-Seconds, the processor time so far of all threads of a
%   role: `worker`, `reader` (of frames) and `other`.

thread_times(Times) :-
    findall(Role-Seconds,
            ( member(Role, [worker, reader, other]),
              aggregate_all(sum(S), thread_time(Role, _, S), Seconds) ),
            Times).

thread_time(Role, Thread, Seconds) :-
    thread_property(Thread, status(running)),
    thread_role(Thread, Role),
    thread_statistics(Thread, cputime, Seconds).

thread_role(Thread, Role) :-
    (   thread_property(Thread, alias(Alias)),
        alias_role(Prefix, Role0),
        sub_atom(Alias, 0, _, _, Prefix)
    ->  Role = Role0
    ;   Role = other
    ).

alias_role(typhon_worker_, worker).
alias_role(typhon_in_, reader).
alias_role(typhon_out_, reader).

%!  sampling_begin(+Role) is det.
%
%   Starts to sample the thread of Role that has worked most. It must not have
%   been sampled before.

sampling_begin(Role) :-
    findall(Seconds-Thread, thread_time(Role, Thread, Seconds), Pairs),
    max_member(_-Thread, Pairs),
    thread_self(Me),
    thread_signal(Thread, bench_sampled:begin(Me)),
    thread_get_message(sampling(Cpu)),
    assertz(sampled(Thread, Cpu)).

begin(Asker) :-
    statistics(cputime, Cpu),
    thread_send_message(Asker, sampling(Cpu)),
    profiler(_, walltime).

%!  sampling_end(-Cpu-Seen, -Spent) is det.
%
%   Cpu is the processor time of the thread since sampling_begin/1, in
%   seconds, Seen the time in which it seemed to work: more than Cpu if it had
%   to wait for a processor. Spent are facts spent(Source, How, Seconds), How
%   is `itself` or, for system predicates that it called, `called`. Source is a
%   file such as `wire/reader`, `agent` for programs of agents, `garbage
%   collection`, `waiting` or `not known`.

sampling_end(Cpu-Seen, [spent(waiting, called, Waiting)|Spent]) :-
    retract(sampled(Thread, Cpu0)),
    thread_self(Me),
    thread_signal(Thread, bench_sampled:end(Me)),
    thread_get_message(sampling(Cpu1, Books, Spent0)),
    Cpu is Cpu1-Cpu0,
    exclude([spent(waiting,_,_)]>>true, Spent0, Spent),
    aggregate_all(sum(S), member(spent(_, _, S), Spent), Seen0),
    Seen is Seen0+Books,
    Waiting is max(0.0, Cpu-Seen).

end(Asker) :-
    profiler(_, false),
    statistics(cputime, Cpu),
    findall(spent(Source, How, Seconds), spent(Source, How, Seconds), Spent),
    books(Books),
    thread_send_message(Asker, sampling(Cpu, Books, Spent)).

                /*******************************
                *       CALLS AND MODULES      *
                *******************************/

%   spent(-Source, -How, -Seconds) is nondet. Ticks should be milliseconds, but
%   the profiler drops the rest of each interval: so the total time is divided
%   in proportion to the ticks.

spent(Source, How, Seconds) :-
    '$prof_statistics'(_, Ticks, _, Time, _),
    below(-, 'not known', Node, Source, How),
    '$prof_node'(Node, _, _, _, _, _, Own, _),
    Own > 0,
    Seconds is Own*Time/Ticks.

books(Seconds) :-
    '$prof_statistics'(_, Ticks, Books, Time, _),
    Seconds is Books*Time/max(1, Ticks).

%   below(+Above, +SourceAbove, -Node, -Source, -How) is nondet.

below(Above, SourceAbove, Node, Source, How) :-
    '$prof_sibling_of'(Node0, Above),
    '$prof_node'(Node0, Predicate, _, _, _, _, _, _),
    counts_for(Predicate, SourceAbove, Source0, How0),
    (   Node = Node0, Source = Source0, How = How0
    ;   below(Node0, Source0, Node, Source, How)
    ).

counts_for(Predicate, _, waiting, called) :-
    waits(Predicate),
    !.
counts_for(system:'$garbage_collect'/1, _, 'garbage collection', called) :-
    !.
counts_for(Module:_, SourceAbove, Source, How) :-
    (   module_source(Module, Source0)
    ->  Source = Source0, How = itself
    ;   Source = SourceAbove, How = called
    ).

waits(system:thread_get_message/_).
waits(system:wait_for_input/3).
waits(system:peek_byte/2).

%   Fails for the system and its libraries.

module_source(Module, Source) :-
    module_property(Module, file(File)),
    atomic_list_concat([_,Path], '/prolog/typhon/', File),
    !,
    file_name_extension(Source, pl, Path).
module_source(Module, agent) :-
    \+ module_property(Module, file(_)),
    \+ module_property(Module, class(system)).
