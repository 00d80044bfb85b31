:- module(test_tartarus_nodes,
          [ with_nodes/3,               % +Programs, -Nodes, :Goal
            type/2,                     % +Node, +Text
            printed/2,                  % +Node, +Lines
            printed/3,                  % +Node, +Lines, +Seconds
            node_output/2,              % +Node, -Text
            ports/2                     % +Count, -Ports
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_kill/2,
                                 process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(common, [ free_port/1, make_tmp_dir/1, project_file/2, wait_until/2,
                        with_tmp_dir/1 ]).
:- use_module(quick_swipl, [quick_swipl/3]).

/** <module> Platforms of Tartarus, each a process of its own

A node is a Prolog top level that has loaded library(tartarus) and a program;
tests type queries, and check the output.

*Threading*: one test at a time.
*/

:- meta_predicate
    with_nodes(+, -, 0).

%!  with_nodes(+Programs:list, -Nodes:list, :Goal) is semidet.
%
%   Call Goal once while there are Nodes with these Programs, lists of lines.

with_nodes(Programs, Nodes, Goal) :-
    with_tmp_dir(test_tartarus_nodes:in_dir(Programs, Nodes, Goal)).

in_dir(Programs, Nodes, Goal, Dir) :-
    setup_call_cleanup(
        begin(Programs, 1, Dir, Nodes),
        once(Goal),
        maplist(end, Nodes)).

begin([], _, _, []).
begin([Program|Programs], I, Dir, [Node|Nodes]) :-
    node(Program, I, Dir, Node),
    I1 is I+1,
    begin(Programs, I1, Dir, Nodes).

node(Program, I, Dir, node(Pid, In, OutFile)) :-
    file(Dir, program, I, pl, File),
    file(Dir, out, I, txt, OutFile),
    setup_call_cleanup(
        open(File, write, Stream),
        forall(member(Line, Program), format(Stream, '~w~n', [Line])),
        close(Stream)),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    platform(Swipl),
    setup_call_cleanup(
        open(OutFile, write, Out),
        process_create(Swipl,
                       [ '-q', '-p', Path, '-g', 'use_module(library(tartarus))',
                         File ],
                       [ cwd(Dir), stdin(pipe(In)), stdout(stream(Out)),
                         stderr(stream(Out)), process(Pid) ]),
        close(Out)).

%   A process makes one state for all its nodes.

:- table platform/1.

platform(Swipl) :-
    make_tmp_dir(Dir),
    at_halt(delete_directory_and_contents(Dir)),
    quick_swipl(quick_tartarus, Dir, Swipl).

file(Dir, Name, I, Extension, File) :-
    format(atom(Base), '~w~d.~w', [Name, I, Extension]),
    directory_file_path(Dir, Base, File).

end(node(Pid, In, _)) :-
    process_kill(Pid, kill),
    process_wait(Pid, _),
    close(In, [force(true)]).

%!  type(+Node, +Text) is det.
%
%   Type a line.

type(node(_, In, _), Text) :-
    format(In, '~w~n', [Text]),
    flush_output(In).

%!  printed(+Node, +Texts:list) is det.
%!  printed(+Node, +Texts:list, +Seconds) is det.
%
%   Wait until Node has printed these texts, in this order.
%
%   @error timeout_error(wait_until, _), and what it printed is shown

printed(Node, Texts) :-
    printed(Node, Texts, 20).

printed(Node, Texts, Seconds) :-
    catch(wait_until(test_tartarus_nodes:in_order(Node, Texts), Seconds),
          error(timeout_error(_, _), _),
          ( node_output(Node, Text),
            throw(error(not_printed(Texts, Text), _)) )).

in_order(Node, Texts) :-
    node_output(Node, Text),
    in_order(Texts, 0, Text).

in_order([], _, _).
in_order([Text|Texts], From, All) :-
    sub_string(All, Before, Length, _, Text),
    Before >= From,
    !,
    Next is Before+Length,
    in_order(Texts, Next, All).

%!  node_output(+Node, -Text:string) is det.
%
%   Its output so far.

node_output(node(_, _, File), Text) :-
    read_file_to_string(File, Text, []).

%!  ports(+Count, -Ports:list) is det.

ports(Count, Ports) :-
    length(Ports, Count),
    maplist(free_port, Ports).
