:- module(layers_index,
          [ layer_problem/1,            % -Problem
            index_problem/1,            % -Problem
            index_file/1,               % -File
            write_index/0
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(solution_sequences), [distinct/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(parts, [is_part/1]).
:- use_module(tree).

/** <module> The index of what is loaded on demand

A file below prolog/typhon that library(typhon) does not import, directly or
indirectly, is loaded on demand. The index says which hooks such files define,
for which kinds of things, and which settings, so that they are known before
they are loaded; see module `typhon_on_demand`.

*Threading*: the main thread.
*/

%!  indexed(+Hook, -Seam, +Head, -What) is semidet.
%
%   Hook is in the index under Seam: a clause of Head is for What.
%   Options are there under their domain, by name.

indexed(typhon_endpoint:requested/4, requested, requested(Kind, _, _, _), Kind).
indexed(typhon_endpoint:received/3, received, received(Kind, _, _), Kind).
indexed(typhon_on_demand:joins/2, Seam, joins(Seam, What), What).
indexed(typhon_questions:here/3, question, here(Question, _, _), Kind) :-
    callable(Question),
    functor(Question, Kind, _).
indexed(typhon_agents:carries/3, carries, carries(Name, _, _), Name).
indexed(typhon_orders:carried_out/3, order, carried_out(Order, _, _), Kind) :-
    callable(Order),
    functor(Order, Kind, _).
indexed(typhon_hosts:one_of/2, description, one_of(Description, _), Kind) :-
    callable(Description),
    functor(Description, Kind, _).
indexed(typhon_time:starts/1, time, starts(Kind), Kind).
indexed(typhon_store:backend_place/4, journal,
        backend_place(Form, _, _, _), Form).
indexed(typhon_durable:durable/5, durable, durable(Kind, _, _, _, _), Kind).
indexed(typhon_durable:durable/6, durable, durable(Kind, _, _, _, _, _), Kind).

%!  layer_problem(-Problem) is nondet.
%!  index_problem(-Problem) is nondet.
%
%   A file stands beside the layers, so the index leaves out its hooks and
%   settings; the index is not up to date.

layer_problem(no_layer(File)) :-
    inside('prolog/typhon/', Prefix),
    tree_file(File),
    atom_concat(Prefix, _, File),
    \+ layer_file(File, _),
    \+ face(File).

index_problem(stale_index(File)) :-
    index_file(File),
    index_text(Text),
    \+ read_file_to_string(File, Text, []).

index_file(File) :-
    inside('prolog/typhon/kernel/base/index.pl', File).

%!  write_index is det.

write_index :-
    index_file(File),
    index_text(Text),
    setup_call_cleanup(
        open(File, write, Out),
        write(Out, Text),
        close(Out)).

index_text(Text) :-
    findall(Seam-(Part-What), part_joins(Seam, What, Part), Joins0),
    sort(Joins0, Joins),
    findall(joins(Seam, Part, Whats),
            bagof(What, member(Seam-(Part-What), Joins), Whats), Seams),
    findall(files(Part, Files),
            ( distinct(Part, member(_-(Part-_), Joins)),
              setof(Path, part_file(Part, Path), Files) ),
            Parts0),
    sort(Parts0, Parts),
    findall(Setting, part_setting(Setting), Settings0),
    sort(Settings0, Settings),
    with_output_to(string(Text), print_index(Seams, Parts, Settings)).

print_index(Seams, Parts, Settings) :-
    format(':- module(typhon_index,
          [ part_joins/3,               % ?Seam, ?What, ?Part
            part_file/2,                % ?Part, ?File
            part_setting/6              % ?Name, ?Module, ?Type, ?Default, ?Text,
                                        % ?File
          ]).
:- use_module(library(lists), [member/2]).

/** <module> What is loaded on demand

Made by `swipl doc/layers.pl -- index`, and compared by `make check`.

*Threading*: facts.
*/

%!  part_joins(?Seam, ?What, ?Part) is nondet.
%
%   Part defines the hook Seam for What.

part_joins(Seam, What, Part) :-
    joins(Seam, Part, Whats),
    member(What, Whats).

~@
%!  part_file(?Part, ?File) is nondet.
%
%   File, below prolog/typhon, defines hooks of Part.

part_file(Part, File) :-
    files(Part, Files),
    member(File, Files).

~@
%!  part_setting(?Name, ?Module, ?Type, ?Default, ?Text, ?File) is nondet.
%
%   File declares the setting Module:Name.

~@',
           [print_facts(Seams), print_facts(Parts), print_facts(Settings)]).

print_facts(Facts) :-
    forall(member(Fact, Facts), format('~q.~n', [Fact])).

part_joins(Seam, What, Part) :-
    on_demand(File, Part),
    hook_clause(File, Module:Head),
    functor(Head, Hook, Arity),
    indexed(Module:Hook/Arity, Seam, Head, What),
    ground(Seam-What).
part_joins(Domain, Name, Part) :-
    on_demand(File, Part),
    hook_clause(File, typhon_options:declared(Domain, Option, _, _)),
    atom(Domain),
    callable(Option),
    functor(Option, Name, _).

part_file(Part, Path) :-
    on_demand(File, Part),
    once(( hook_clause(File, Module:_), atom_concat(typhon_, _, Module) )),
    \+ is_part(File),                   % loaded by the layer, if it is there
    path(File, Path).

part_setting(part_setting(Name, Module, Type, Default, Text, Path)) :-
    on_demand(File, _),
    setting_of(File, Module:Name, Type, Default, Text0),
    atom_string(Text, Text0),
    path(File, Path).

path(File, Path) :-
    inside('prolog/typhon/', Prefix),
    atom_concat(Prefix, Relative, File),
    file_name_extension(Path, pl, Relative).

%!  on_demand(?File, ?Part) is nondet.
%
%   File is of the layer Part and not loaded with library(typhon).

on_demand(File, Part) :-
    loaded_at_once(AtOnce),
    layer_file(File, Part),
    \+ memberchk(File, AtOnce).

:- dynamic at_once/1.

loaded_at_once(Files) :-
    at_once(Files),
    !.
loaded_at_once(Files) :-
    inside('prolog/typhon.pl', Interface),
    reached([Interface], [], Files),
    assertz(at_once(Files)).

reached([], Files, Files).
reached([File|More], Seen, Files) :-
    memberchk(File, Seen),
    !,
    reached(More, Seen, Files).
reached([File|More], Seen, Files) :-
    findall(Next, ( loads(File, Next), module_of(Next, _) ), Nexts, More),
    reached(Nexts, [File|Seen], Files).

loads(File, Next) :-
    import(File, Next, _),
    \+ autoloads(File, Next).
loads(File, Next) :-
    reexport(File, Next, _).
