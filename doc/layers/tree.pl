:- module(layers_tree,
          [ read_tree/0,
            read_library/0,
            tree_file/1,        % -File
            module_of/2,        % ?File, ?Module
            export/2,           % ?File, ?PI
            import/3,           % ?File, ?Target, ?List
            reexport/3,         % ?File, ?Target, ?List
            autoloads/2,        % ?File, ?Target
            mentions/2,         % ?File, ?Name
            reaches/3,          % ?File, ?Module, ?PI
            declares/2,         % ?File, ?Hook
            publishes/2,        % ?File, ?PI
            stores/2,           % ?File, ?Table
            defines/2,          % ?File, ?Hook
            hook_clause/2,      % ?File, ?Head
            setting_of/5,       % ?File, ?Name, ?Type, ?Default, ?Text
            size/4,             % ?File, ?PI, ?First, ?Last
            nodes/2,            % ?File, ?Count
            pauses/2,           % ?File, -Count
            waits_by_day/1,     % ?File
            inside/2,           % ?Relative, ?File
            layers/1,           % -Layers
            layer_module/3,     % ?File, ?Layer, ?Name
            interface/2,        % ?File, ?Layer
            layer_file/2,       % ?File, ?Layer
            face/1,             % ?File
            offered/3           % +Module, +List, ?PI
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(prolog_code), [comma_list/2]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(operators), [push_op/3]).
:- use_module(library(prolog_source),
              [prolog_close_source/1, prolog_open_source/2]).

/** <module> The files of the tree, read as facts

*Threading*: the main thread.
*/

:- dynamic
    root/1,                     % Directory of the tree
    module_of/2,                % File, Module
    export/2,                   % File, PI
    import/3,                   % File, Target, all or List; a file, if ours
    reexport/3,                 % as import/3
    autoloads/2,                % File, Target: the import is an autoload/2
    mentions/2,                 % File, Name: in clauses and directives
    reaches/3,                  % File, Module, PI: Module:Goal in a clause
    declares/2,                 % File, Module:PI: multifile
    publishes/2,                % File, PI: public
    stores/2,                   % File, Module:PI: dynamic or thread_local
    defines/2,                  % File, Module:PI: a clause for that module
    hook_clause/2,              % File, Module:Head: that clause
    setting_of/5,               % File, Module:Name, Type, Default, Text
    size/4,                     % File, PI, first and last line
    nodes/2,                    % File, Count: nodes of the term of a clause
    agent_program/1,            % File
    clause_pauses/2,            % File, Count: of a clause
    waits_by_day/1.             % File: calls a wait of Prolog with a timeout

:- prolog_load_context(directory, Dir),
   file_directory_name(Dir, Doc),
   file_directory_name(Doc, Root),
   retractall(root(_)),
   assertz(root(Root)).

                /*******************************
                *           READING            *
                *******************************/

read_tree :-
    style_check(-singleton),
    forall(tree_file(File), read_source(File)).

%   What the library alone needs: prolog/.

read_library :-
    style_check(-singleton),
    forall(file_below(prolog, File), read_source(File)).

tree_file(File) :-
    member(Top, [prolog, app, agents, payloads, examples, experiments, test,
                 bench, doc]),
    file_below(Top, File).

file_below(Top, File) :-
    root(Root),
    directory_file_path(Root, Top, Dir),
    directory_member(Dir, File, [recursive(true), extensions([pl])]).

read_source(File) :-
    setup_call_cleanup(
        prolog_open_source(File, In),
        ( set_stream(In, encoding(utf8)),
          read_terms(In, File) ),
        prolog_close_source(In)).

read_terms(In, File) :-
    repeat,
    read_term(In, Term, [ module(user), term_position(Position),
                          syntax_errors(error) ]),
    (   Term == end_of_file
    ->  !
    ;   stream_position_data(line_count, Position, First),
        line_count(In, Last),
        note(Term, File, First, Last),
        fail
    ).

note((:- Directive), File, _, _) :-
    !,
    note_operators(Directive),
    note_directive(Directive, File).
note(Clause, File, First, Last) :-
    phrase(parts(Clause), Parts),
    note_names_of(Parts, File),
    length(Parts, Nodes),
    assertz(nodes(File, Nodes)),
    note_pauses(Clause, File),
    note_waits(Parts, File),
    (   clause_head(Clause, Module:Head)
    ->  functor(Head, Name, Arity),
        assertz(defines(File, Module:Name/Arity)),
        assertz(hook_clause(File, Module:Head))
    ;   clause_head(Clause, Head)
    ->  functor(Head, Name, Arity),
        assertz(size(File, Name/Arity, First, Last))
    ;   true
    ).

%   parts(+Term)//: all terms in Term.

parts(Term) -->
    [Term],
    (   { compound(Term),
          compound_name_arguments(Term, _, Args) }
    ->  foldl(parts, Args)
    ;   []
    ).

%   Operators hold up to the end of the file. Library(xpath) is the only one
%   whose operators the tree uses.

note_operators(op(Priority, Type, Names)) :-
    !,
    ( is_list(Names) -> List = Names ; List = [Names] ),
    forall(member(Name, List), push_op(Priority, Type, user:Name)).
note_operators(use_module(library(xpath))) :-
    !,
    use_module(library(xpath), []),
    module_property(xpath, exported_operators(Operators)),
    forall(member(op(Priority, Type, Name), Operators),
           push_op(Priority, Type, user:Name)).
note_operators(_).

%   The goals sleep(_) of control structures are pauses. A clause inside a
%   clause is one of an agent, which does not occupy a thread while it sleeps.

note_pauses(Clause, File) :-
    (   Clause = (_:-Body),
        aggregate_all(count, pause_in(Body, (_:-Body)), Count),
        Count > 0
    ->  assertz(clause_pauses(File, Count))
    ;   true
    ).

pause_in(Term, Around) :-
    compound(Term),
    Term \= (_:-_),
    (   Term = sleep(_),
        functor(Around, Name, _),
        memberchk(Name, [(:-), (','), ;, ->, *->, \+, :])
    ;   arg(_, Term, Part),
        pause_in(Part, Term)
    ).

note_waits(Parts, File) :-
    (   member(Term, Parts),
        is_timed(Term),
        \+ waits_by_day(File)
    ->  assertz(waits_by_day(File))
    ;   true
    ).

is_timed(Term) :-
    compound(Term),
    compound_name_arguments(Term, Name, [_, _, Options]),
    memberchk(Name, [thread_get_message, thread_send_message]),
    Options \== [timeout(0)].

%   pauses(?File, -Count): File calls sleep/1 at so many places.

pauses(File, Count) :-
    tree_file(File),
    \+ agent_program(File),
    aggregate_all(sum(N), clause_pauses(File, N), Count).

clause_head((Head-->_), Head) :- !, callable(Head).
clause_head((Head:-_), Head) :- !, callable(Head).
clause_head((Head=>_), Head) :- !, callable(Head).
clause_head(Head, Head) :- callable(Head).

note_directive(module(Module, Exports), File) :-
    !,
    assertz(module_of(File, Module)),
    forall(member(PI, Exports), assertz(export(File, PI))).
note_directive(use_module(Spec), File) :-
    !,
    note_import(import, File, Spec, all).
note_directive(use_module(Spec, List), File) :-
    !,
    note_import(import, File, Spec, List).
note_directive(autoload(Spec, List), File) :-
    !,
    note_import(import, File, Spec, List),
    target(Spec, File, Target),
    assertz(autoloads(File, Target)).
note_directive(reexport(Spec), File) :-
    !,
    note_import(reexport, File, Spec, all).
note_directive(reexport(Spec, List), File) :-
    !,
    note_import(reexport, File, Spec, List).
note_directive(include(Spec), File) :-
    !,
    note_import(import, File, Spec, include).
note_directive(multifile(PIs), File) :-
    !,
    note_names(PIs, File),
    module_of(File, Module),
    forall(( comma_member(PI, PIs), strip_module(Module:PI, M, Name) ),
           note_declared(File, M, Name)).
note_directive(public(PIs), File) :-
    !,
    forall(comma_member(PI, PIs), assertz(publishes(File, PI))).
note_directive(Storage, File) :-
    (   Storage = dynamic(PIs)
    ;   Storage = thread_local(PIs)
    ),
    module_of(File, Module),
    !,
    note_names(PIs, File),
    forall(( comma_member(PI, PIs), strip_module(Module:PI, M, Name) ),
           assertz(stores(File, M:Name))).
note_directive(setting(Name0, Type, Default, Text), File) :-
    !,
    note_names(setting(Name0, Type, Default, Text), File),
    module_of(File, Module),
    strip_module(Module:Name0, M, Name),
    assertz(setting_of(File, M:Name, Type, Default, Text)).
note_directive(agent(Name, Options), File) :-
    !,
    note_names(agent(Name, Options), File),
    assertz(agent_program(File)).
note_directive(Directive, File) :-
    note_names(Directive, File),
    (   functor(Directive, durable, Arity),
        Arity >= 5
    ->  assertz(hook_clause(File, typhon_durable:Directive))
    ;   true
    ).

%   A grammar rule is noted with the arity of its head.

note_declared(File, Module, Name//Arity) :-
    !,
    assertz(declares(File, Module:Name/Arity)).
note_declared(File, Module, PI) :-
    assertz(declares(File, Module:PI)).

note_import(Kind, File, Spec, List) :-
    target(Spec, File, Target),
    Fact =.. [Kind, File, Target, List],
    assertz(Fact).

comma_member(X, Conjunction) :-
    comma_list(Conjunction, List),
    member(X, List).

%   target(+Spec, +File, -Target): a file of the tree, else Spec.

target(Spec, File, Target) :-
    root(Root),
    (   Spec = library(Path)
    ->  format(atom(Relative), 'prolog/~w', [Path]),
        directory_file_path(Root, Relative, Base)
    ;   ( atomic(Spec) ; Spec = _/_ )
    ->  file_directory_name(File, Dir),
        format(atom(Path), '~w', [Spec]),
        directory_file_path(Dir, Path, Base)
    ),
    member(Extension, ['.pl', '']),
    atom_concat(Base, Extension, Full),
    exists_file(Full),
    !,
    absolute_file_name(Full, Target).
target(Spec, _, Spec).

note_names(Term, File) :-
    phrase(parts(Term), Parts),
    note_names_of(Parts, File).

note_names_of(Parts, File) :-
    findall(Name, ( member(Part, Parts), name_in(Part, Name) ), Names0),
    sort(Names0, Names),
    forall(( member(Name, Names), \+ mentions(File, Name) ),
           assertz(mentions(File, Name))),
    forall(( member(Part, Parts), reach(Part, Module, PI) ),
           assertz(reaches(File, Module, PI))).

name_in(Part, Part) :-
    atom(Part).
name_in(Part, Name) :-
    compound(Part),
    compound_name_arity(Part, Name, _).
name_in(Part, Name) :-                  % in strings that are run elsewhere
    string(Part),
    split_string(Part, " \n\t()[]{},:;.'|", "", Words),
    member(Word, Words),
    Word \== "",
    atom_string(Name, Word).

reach(Part, Module, Name/Arity) :-
    nonvar(Part),
    Part = Module:Goal,
    atom(Module),
    atom_concat(typhon_, _, Module),
    callable(Goal),
    \+ Goal = _/_,
    functor(Goal, Name, Arity).

                /*******************************
                *     LAYERS AND INTERFACES     *
                *******************************/

%!  layers(-Layers)
%
%   The folders below prolog/typhon that are layers, the lowest first: a layer
%   imports from layers before it.

layers([ 'kernel/base', 'bridges/json',
         'bridges/helper', 'bridges/nxt', 'kernel/program', 'language/chunks', language, 'kernel/wire',
         'kernel/host', 'kernel/agent', 'language/faults', 'kernel/travel',
         'kernel/lifecycle', 'kernel/vocabulary', 'options/payloads',
         'options/remote',
         'tools/administration', 'tools/checks', 'tools/source_view',
         'options/migration', 'options/keys', 'options/tls',
         'options/identity', 'options/trail', 'options/journal',
         'options/single', 'options/snapshot', 'options/access',
         'options/concurrency', 'options/people',
         'options/external_recipients',
         'options/guard', 'options/host_log', 'options/quotas',
         'options/cell', 'options/fleet', 'options/trace', 'options/virtual',
         network,
         'options/watch', 'options/supervision', 'options/directory', tools,
         'bridges/common', 'bridges/python', 'bridges/mqtt', 'bridges/gpio',
         'bridges/fipa', 'bridges/ros', 'tools/page' ]).

%!  layer_module(?File, ?Layer, ?Name) is nondet.
%!  interface(?File, ?Layer) is nondet.
%!  layer_file(?File, ?Layer) is nondet.
%
%   File is a module inside the folder of Layer; is the interface of Layer,
%   which stands beside the folder, or in prolog/typhon if programs of users
%   import it; is one of both, and no face.  They are tabled, as checks ask them
%   for each call of each file.

:- table layer_module/3, interface/2.

layer_module(File, Layer, Name) :-
    module_of(File, _),
    inside('prolog/typhon/', Prefix),
    atom_concat(Prefix, Relative, File),
    file_directory_name(Relative, Layer),
    Layer \== '.',
    is_layer(Layer),
    file_base_name(Relative, Base),
    file_name_extension(Name, pl, Base),
    \+ interface(File, _).

interface(File, Layer) :-
    is_layer(Layer),
    (   Path = Layer
    ;   file_base_name(Layer, Path),
        Path \== Layer
    ),
    format(atom(Relative), 'prolog/typhon/~w.pl', [Path]),
    inside(Relative, File).

layer_file(File, Layer) :-
    layer_module(File, Layer, _).
layer_file(File, Layer) :-
    interface(File, Layer),
    \+ face(File).

%!  face(?File) is nondet.
%
%   Programs of users import File.

face(File) :-
    member(Path, [ 'prolog/typhon.pl', 'prolog/typhon/kernel.pl',
                   'prolog/typhon/nxt.pl', 'prolog/typhon/python.pl',
                   'prolog/typhon/mqtt.pl', 'prolog/typhon/ros.pl',
                   'prolog/typhon/fipa.pl', 'prolog/typhon/gpio.pl' ]),
    inside(Path, File).

is_layer(Layer) :-
    layers(Layers),
    member(Layer, Layers).

%!  offered(+Module, +List, ?PI) is nondet.
%
%   PI is imported from Module by an import of List, `all` or except(Others).

offered(Module, all, PI) :-
    export(Module, PI).
offered(Module, all, PI) :-
    reexport(Module, Deeper, List),
    offered(Deeper, List, PI).
offered(Module, except(Others), PI) :-
    offered(Module, all, PI),
    \+ memberchk(PI, Others).
offered(_, List, PI) :-
    is_list(List),
    member(PI, List).

%!  inside(+Relative, -File) is det.

inside(Relative, File) :-
    root(Root),
    directory_file_path(Root, Relative, File).
