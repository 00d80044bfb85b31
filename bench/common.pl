:- module(bench_common,
          [ figure/3,                   % +Name, +Value, +Unit
            figure/4,                   % +Name, +Value, +Unit, +Note
            ratio/5,                    % +Name, +A, +B, +Unit, +What
            seconds/2,                  % :Goal, -Seconds
            resident_bytes/1,           % -Bytes
            threads/1,                  % -Count
            measured/3,                 % +Measure, +Count, :Goal
            told/1,                     % +Fact
            with_peer/2,                % +Prefix, :Goal
            with_peer/3,                % +Prefix, +Options, :Goal
            peer_main/1,                % +Options
            pinned/2                    % +Placement, -Prefixes
          ]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil),
              [read_line_to_string/2, read_file_to_string/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(apply), [exclude/3]).

/** <module> Common predicates of the benchmarks

A benchmark is a process that prints facts figure(Name, Value, Unit, Note)
on its standard output; bench/run.pl starts it and makes the table.
*/

:- meta_predicate
    seconds(0, -),
    measured(+, +, 0),
    with_peer(+, 1),
    with_peer(+, +, 1).

:- prolog_load_context(directory, Dir),
   atom_concat(Dir, '/../prolog', Prolog),
   asserta(user:file_search_path(library, Prolog)).

:- multifile user:file_search_path/2.
:- dynamic user:file_search_path/2.

%!  figure(+Name, +Value, +Unit) is det.
%!  figure(+Name, +Value, +Unit, +Note) is det.
%!  ratio(+Name, +A, +B, +Unit, +What) is det.
%
%   Prints a figure, or A/B with both sides.

figure(Name, Value, Unit) :-
    figure(Name, Value, Unit, '').

ratio(Name, A, B, Unit, What) :-
    Ratio is A/B,
    format(atom(Note), '~3g ~w against ~3g (~w)', [A, Unit, B, What]),
    figure(Name, Ratio, times, Note).

figure(Name, Value0, Unit, Note) :-
    Value is float(Value0),
    format('figure(~q, ~4g, ~q, ~q).~n', [Name, Value, Unit, Note]),
    flush_output.

%!  seconds(:Goal, -Seconds) is det.

seconds(Goal, Seconds) :-
    get_time(T0),
    once(Goal),
    get_time(T1),
    Seconds is T1-T0.

%!  resident_bytes(-Bytes) is det.
%!  threads(-Count) is det.
%
%   Resident memory and threads of this process, according to the system.

resident_bytes(Bytes) :-
    status('VmRSS:', KB),
    Bytes is KB*1024.

threads(Count) :-
    status('Threads:', Count).

status(Key, Number) :-
    read_file_to_string('/proc/self/status', Text, []),
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    sub_string(Line, 0, _, _, Key),
    !,
    split_string(Line, "\t ", "\t ", Words0),
    exclude(==(""), Words0, [_,Word|_]),
    number_string(Number, Word).

%!  measured(+Measure, +Count, :Goal) is det.
%!  told(+Fact) is det.
%
%   The protocol of bench/peers.pl: writes a fact, and waits for a line.

measured(Measure, Count, Goal) :-
    told(begin),
    call(Goal),
    told(done(Measure, Count)).

told(Fact) :-
    format('~q.~n', [Fact]),
    flush_output,
    read_line_to_string(user_input, _).

%!  with_peer(+Prefix, :Goal) is det.
%!  with_peer(+Prefix, +Options, :Goal) is det.
%
%   Calls Goal(Address) while a second process runs the host with that address,
%   started with Options.  Prefix is put before its command line.

with_peer(Prefix, Goal) :-
    with_peer(Prefix, [], Goal).

with_peer(Prefix, Options, Goal) :-
    module_property(bench_common, file(File)),
    current_prolog_flag(executable, Swipl),
    format(atom(Main), 'bench_common:peer_main(~q)', [Options]),
    append(Prefix, [Swipl, '-q', '-g', Main, '-t', halt, File],
           [Program|Args]),
    setup_call_cleanup(
        process_create(path(Program), Args,
                       [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
        ( read_line_to_string(Out, Line),
          atom_string(Address, Line),
          call(Goal, Address)
        ),
        ( close(In), process_wait(Pid, _), close(Out) )).

%   The peer ends when its standard input ends.

peer_main(Options) :-
    use_module(library(typhon)),
    typhon:host_start(peer, Options),
    typhon:host_property(peer, address(Address)),
    format('~w~n', [Address]),
    flush_output,
    read_line_to_string(user_input, _).

%!  pinned(?Placement, -Prefixes) is nondet.
%
%   Prefixes are the prefixes of the command lines of the two processes.

pinned(unpinned, [env]-[env]).
pinned(same_cpu, [taskset, '-c', '0']-[taskset, '-c', '0']).
pinned(one_each, [taskset, '-c', '0']-[taskset, '-c', '1']).
