:- module(layers_loaded, [loaded_problem/1]).   % -Problem
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(prolog_codewalk), [prolog_walk_code/1]).
:- use_module(tree).

/** <module> What shows once all modules are loaded

All modules of Typhon are loaded, as in a process without autoloading:

  - each inherits from `system`, so that no definition of a user is in its way;
  - each imports, or declares by autoload/2, what it calls, also in arguments
    of meta predicates;
  - where clauses are stored as they are read, see typhon_compiling, nothing in
    them would be expanded.

*Threading*: the main thread.
*/

%!  loaded_problem(-Problem) is nondet.

loaded_problem(Problem) :-
    inside('prolog/typhon.pl', Library),
    use_module(Library, []),
    findall(File-Module,
            ( product_module(File, Module),
              typhon_compiling:is_plain(File) ),
            Plain),
    forall(member(File-_, Plain), use_module(File, [])),
    findall(expanded(Module, PI),
            ( member(_-Module, Plain), expanded(Module, PI) ),
            Expanded),
    forall(product_module(File, _), use_module(File, [])),
    set_prolog_flag(autoload, false),
    (   product_module(_, Module),
        \+ import_module(Module, system),
        Problem = inherits(Module)
    ;   prolog_walk_code([ autoload(false), undefined(trace), source(false),
                           on_trace(layers_loaded:keep) ]),
        missing(Module, PI),
        Problem = not_imported(Module, PI)
    ;   member(Problem, Expanded)
    ).

expanded(Module, Name/Arity) :-
    module_property(Module, class(user)),
    '$c_current_predicate'(_, Module:Head),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    '$get_predicate_attribute'(Module:Head, number_of_clauses, _),
    clause(Module:Head, Body),
    once(( sub_term(Part, Head-Body), is_expanded(Part) )),
    functor(Head, Name, Arity).

is_expanded(Part) :-
    compound(Part),
    (   Part = (Parameters>>_)
    ->  nonvar(Parameters),
        ( is_list(Parameters) ; Parameters = _/_ )
    ;   compound_name_arity(Part, '.', 2)
    ).

product_module(File, Module) :-
    member(Folder, [ 'prolog/', 'agents/', 'app/', 'experiments/', 'doc/',
                     'bench/', 'examples/', 'test/lib/' ]),
    inside(Folder, Start),
    module_of(File, Module),
    atom_concat(Start, _, File).

:- dynamic missing/2.                   % Module, PI

%   Library(main) defines the hooks opt_type/3 and its like where it needs them.
%   Programs as data have atoms that look like closures: main, true.

:- public keep/3.

keep(Module:Goal, _, _) :-
    functor(Goal, Name, Arity),
    (   module_of(_, Module),
        \+ sub_atom(Name, 0, _, _, opt_),
        \+ memberchk(Name/Arity, [main/1, true/1])
    ->  assertz(missing(Module, Name/Arity))
    ;   true
    ).
