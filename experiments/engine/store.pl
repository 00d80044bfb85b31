:- module(study_store,
          [ run_directory/3,            % +Root, +Run, -Directory
            run_done/3,                 % +Root, +Logs, +Run
            log_file/2,                 % +Directory, -File
            run_result/3,               % +Root, +Run, -Measures
            run_facts/2,                % +Directory, -Facts
            result_save/2,              % +Directory, +Facts
            part_directory/3,           % +Directory, +Pid, -Part
            part_begin/1,               % +Part
            part_install/3,             % +Part, +Directory, +Logs
            part_fail/4,                % +Part, +Directory, +Why, -Failure
            part_remove/1,              % +Part
            left_parts_remove/2         % +Root, +Study
          ]).
:- use_module(library(filesex),
              [ delete_directory_and_contents/1, directory_file_path/3,
                directory_member/3, make_directory_path/1 ]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- autoload(library(socket), [gethostname/1]).
:- use_module(cases, [case_name/3]).
:- use_module(sources, [sources_hash/2, text_hash/2]).
:- use_module(studies, [study_title/3]).

/** <module> The store of runs

A run is a term run(Study, Case, Seed); with replay(Seed) it is that run again,
with a log of all events instead of measures.  Its directory is below Root/STUDY; the
name has the case and the seed, a hash of all parameters and one of all sources.
So runs of other sources are not found, and never mixed in.

While a run is made, the directory is Directory.MACHINE.PID.part; if the run
fails, it is Directory.failed, whose file `output` has the reason.  Sessions
that make the same run at once do not disturb each other.

*Threading*: one thread in a process.
*/

%!  run_directory(+Root, +Run, -Directory) is det.

run_directory(Root, run(Study, Case, Seed), Directory) :-
    study_title(Study, Name, _),
    case_name(Study, Case, CaseName),
    file_text(CaseName, Text),
    dict_pairs(Case, _, Pairs),
    format(string(Values), '~q', [Pairs-Seed]),
    text_hash(Values, Parameters),
    sources_hash(Study, Sources),
    format(atom(Below), '~w/~w,seed=~w-~w-~w',
           [Name, Text, Seed, Parameters, Sources]),
    directory_file_path(Root, Below, Directory).

%   Short enough for the name of a file, and without a slash.

file_text(Name, Text) :-
    atomic_list_concat(Parts, /, Name),
    atomic_list_concat(Parts, :, Whole),
    (   sub_atom(Whole, 0, 100, _, Begin)
    ->  Text = Begin
    ;   Text = Whole
    ).

%!  run_done(+Root, +Logs:boolean, +Run) is semidet.
%
%   Run exists; with its log, if Logs is true and it has one at all.

run_done(Root, Logs, Run) :-
    run_directory(Root, Run, Directory),
    exists_directory(Directory),
    \+ ( Logs == true, lacks_log(Run, Directory) ).

lacks_log(run(_, _, Seed), Directory) :-
    integer(Seed),
    run_facts(Directory, Facts),
    memberchk(events(_), Facts),
    log_file(Directory, File),
    \+ exists_file(File).

%!  log_file(+Directory, -File) is det.

log_file(Directory, File) :-
    directory_file_path(Directory, 'events.pl', File).

%!  run_result(+Root, +Run, -Measures:dict) is semidet.
%
%   The measures, and the `directory` of the run; fails if it does not exist.

run_result(Root, Run, Measures) :-
    run_directory(Root, Run, Directory),
    exists_directory(Directory),
    run_facts(Directory, Facts),
    findall(Name-Value, member(measure(Name, Value), Facts), Pairs),
    dict_create(Measures, measures, [directory-Directory|Pairs]).

%!  run_facts(+Directory, -Facts:list) is det.
%!  result_save(+Directory, +Facts:list) is det.
%
%   Facts are parameter(Name, Value), seed(Seed), measure(Name, Value) and
%   facts that describe the machine.

run_facts(Directory, Facts) :-
    directory_file_path(Directory, 'result.pl', File),
    read_file_to_terms(File, Facts, [encoding(utf8)]).

result_save(Directory, Facts) :-
    directory_file_path(Directory, 'result.pl', File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Fact, Facts), format(Out, '~q.~n', [Fact])),
        close(Out)).

                /*******************************
                *            PARTS             *
                *******************************/

%!  part_directory(+Directory, +Pid, -Part) is det.
%!  part_begin(+Part) is det.
%
%   Part is the directory in which the process Pid of this machine makes the
%   run of Directory; part_begin/1 makes it empty.

part_directory(Directory, Pid, Part) :-
    gethostname(Machine),
    atomic_list_concat([Directory, Machine, Pid, part], '.', Part).

part_begin(Part) :-
    part_remove(Part),
    make_directory_path(Part).

%!  part_install(+Part, +Directory, +Logs:boolean) is det.
%
%   Installs the complete Part; keeps its log if Logs is true.  If another
%   session has made the run meanwhile, or the run lacked its log, only the log
%   is installed.

part_install(Part, Directory, Logs) :-
    failed_directory(Directory, Failed),
    part_remove(Failed),
    log_file(Part, Log),
    (   Logs \== true,
        exists_file(Log)
    ->  delete_file(Log)
    ;   true
    ),
    (   \+ exists_directory(Directory),
        catch(rename_file(Part, Directory), error(_, _), fail)
    ->  true
    ;   log_file(Directory, Old),
        ( exists_file(Log) -> rename_file(Log, Old) ; true ),
        part_remove(Part)
    ).

%!  part_fail(+Part, +Directory, +Why:string, -Failure) is det.
%
%   Adds Why to the output of the run, and keeps the output: Failure is
%   failed(Where, Cause), the directory and the first line of Why.

part_fail(Part, Directory, Why, failed(Failed, Cause)) :-
    failed_directory(Directory, Failed),
    make_directory_path(Part),
    directory_file_path(Part, output, File),
    setup_call_cleanup(
        open(File, append, Out, [encoding(utf8)]),
        write(Out, Why),
        close(Out)),
    split_string(Why, "\n", " ", [Cause|_]),
    part_remove(Failed),
    rename_file(Part, Failed).

failed_directory(Directory, Failed) :-
    atom_concat(Directory, '.failed', Failed).

%!  part_remove(+Part) is det.

part_remove(Directory) :-
    (   exists_directory(Directory)
    ->  delete_directory_and_contents(Directory)
    ;   true
    ).

%!  left_parts_remove(+Root, +Study) is det.
%
%   Removes the remains of killed processes of this machine.

left_parts_remove(Root, Study) :-
    study_title(Study, Name, _),
    directory_file_path(Root, Name, Runs),
    forall(( exists_directory(Runs),
             directory_member(Runs, Part, [extensions([part])]),
             left(Part) ),
           catch(part_remove(Part), error(_, _), true)). % others may, too

left(Part) :-
    atomic_list_concat(Texts, '.', Part),
    append(_, [Text, part], Texts),
    atom_number(Text, Pid),
    part_directory('', Pid, End),
    atom_concat(_, End, Part),
    \+ may_live(Pid).

%   Without /proc every process counts as alive.

may_live(Pid) :-
    (   exists_directory('/proc/self')
    ->  atom_concat('/proc/', Pid, Directory),
        exists_directory(Directory)
    ;   true
    ).
