:- module(layers_check,
          [ problem/1,          % -Problem
            report/1            % +Problem
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(index, [index_problem/1, layer_problem/1]).
:- use_module(kinds, [kinds_problem/1]).
:- use_module(loaded, [loaded_problem/1]).
:- use_module(parts, [parts_problem/1]).
:- use_module(seams).
:- use_module(tree).

/** <module> Violations of the layers, and unused names

A name counts as used where it occurs at all, so an unused name may remain
undetected.

*Threading*: the main thread.
*/

problem(unused_import(File, Target, PI)) :-
    import(File, Target, List),
    \+ inside('prolog/typhon/kernel/vocabulary.pl', File),   % for agents
    is_list(List),
    member(Import, List),
    imported_as(Import, PI, Name),
    \+ mentions_too(File, Name).
problem(unused_export(File, PI)) :-
    layer_file(File, _),
    export(File, PI),
    \+ used(File, PI).
problem(unused_at_interface(Interface, PI)) :-
    interface(Interface, _),
    \+ face(Interface),
    reexport(Interface, Module, List),
    offered(Module, List, PI),
    \+ used(Interface, PI).
problem(no_such_file(File, Target)) :-
    layer_file(File, _),
    ( import(File, Target, _) ; reexport(File, Target, _) ),
    Target \= library(_),
    \+ exists_file(Target).
problem(against_layers(File, Target)) :-
    layer_file(File, Layer),
    ( import(File, Target, _) ; reexport(File, Target, _) ),
    \+ may_import(Layer, Target).
problem(past_interface(File, Module, PI)) :-
    reaches(File, Module, PI),
    PI \= _/0,                          % settings are named like this
    layer_file(File, _),
    \+ module_of(File, Module),
    module_of(Owner, Module),
    layer_file(Owner, _),
    \+ may_be_called(Owner, Module, PI).
problem(no_such_predicate(File, Module, PI)) :-
    reaches(File, Module, PI),
    PI \= _/0,
    \+ layer_file(File, _),
    \+ PI = '[|]'/2,                    % Module:List
    module_of(Owner, Module),
    layer_file(Owner, _),
    \+ has_predicate(Owner, Module, PI).
problem(circle(File)) :-
    layer_module(File, _, _),
    reaches_by_import(File, File).
problem(time_of_day(File, Name)) :-
    tree_file(File),
    of_program(File),
    by_day(File, Name),
    \+ may_use(File, Name).
problem(other_json(File, Library)) :-
    tree_file(File),
    of_program(File),
    import(File, library(Library), _),
    memberchk(Library, [json,http/json,http/http_json]),
    \+ inside('prolog/typhon/bridges/json.pl', File).
problem(stray_comment_end(File)) :-
    size(File, '*/'/0, _, _).
problem(Problem) :-
    seam_problem(Problem).
problem(Problem) :-
    layer_problem(Problem).
problem(Problem) :-
    index_problem(Problem).
problem(Problem) :-
    kinds_problem(Problem).
problem(Problem) :-
    parts_problem(Problem).
problem(Problem) :-
    loaded_problem(Problem).

%   of_program(+File) is semidet.
%   by_day(+File, -Name) is nondet.
%   may_use(+File, +Name) is semidet.
%
%   Programs in these folders wait and measure by typhon_monotonic, since the
%   time of day can be set, or, as agents, by the clocks of hosts.  Those that
%   may use the time of day have dates that others read, or compare the times
%   of files; a wrong end of the wait of an idle worker is harmless.

of_program(File) :-
    member(Top, ['prolog/', 'app/', 'agents/', 'payloads/', 'experiments/',
                 'examples/']),
    inside(Top, Prefix),
    atom_concat(Prefix, _, File),
    !.

by_day(File, Name) :-
    member(Name, [ get_time, thread_wait, thread_idle, call_with_time_limit,
                   alarm_at ]),
    mentions(File, Name).
by_day(File, wait) :-
    waits_by_day(File).

may_use(File, Name) :-
    may_use_by_day(Relative, Names),
    memberchk(Name, Names),
    inside(Relative, File),
    !.

may_use_by_day('prolog/typhon/kernel/base/monotonic.pl', [get_time,wait]).
may_use_by_day('prolog/typhon/kernel/base/fifo.pl', [wait]).   % defines it
may_use_by_day('prolog/typhon/kernel/host/scheduler.pl', [wait]).
may_use_by_day('prolog/typhon/kernel/host/turns.pl', [get_time]).
may_use_by_day('prolog/typhon/language/faults.pl', [get_time]).
may_use_by_day('prolog/typhon/language/source.pl', [get_time]).
may_use_by_day('prolog/typhon/options/access.pl', [get_time]).
may_use_by_day('prolog/typhon/options/keys.pl', [get_time]).
may_use_by_day('prolog/typhon/options/people/person_questions.pl', [get_time]).
may_use_by_day('prolog/typhon/bridges/fipa/letter.pl', [get_time]).
may_use_by_day('prolog/typhon/bridges/fipa/managers.pl', [get_time]).
may_use_by_day('prolog/typhon/tools/problem_text.pl', [call_with_time_limit]).
may_use_by_day('prolog/tartarus/lives.pl', [thread_wait]).  % has no timeout
may_use_by_day('prolog/tartarus/moves.pl', [get_time]).
may_use_by_day('prolog/tartarus/messages.pl', [get_time]).
may_use_by_day('payloads/fipa/contract_net.pl', [get_time]).

%   has_predicate(+File, +Module, +PI) is semidet: File, of Module, defines,
%   declares or imports PI, or a predicate with more arguments, as closures have.

has_predicate(File, _, Name/Arity) :-
    size(File, Name/More, _, _),
    More >= Arity,
    !.
has_predicate(_, Module, PI) :-
    ( stores(_, Module:PI) ; declares(_, Module:PI) ),
    !.
has_predicate(File, _, PI) :-
    ( import(File, Target, List) ; reexport(File, Target, List) ),
    (   is_list(List)
    ->  memberchk(PI, List)
    ;   export(Target, PI)
    ),
    !.

%   What a file includes is a part of it.

mentions_too(File, Name) :-
    mentions(File, Name),
    !.
mentions_too(File, Name) :-
    import(File, Part, include),
    mentions_too(Part, Name),
    !.

imported_as((PI as New), PI, New) :- !.
imported_as(Name/Arity, Name/Arity, Name).
imported_as(Name//Arity, Name//Arity, Name).

%   used(+File, +PI): a module that imports File mentions it, or it is
%   offered on. What only its own tests use is not used.

used(File, _) :-
    import(File, _, List),
    is_list(List),
    memberchk(vocabulary/1, List),
    !.                                  % agents do
used(File, Name/_) :-
    import(User, File, List),
    User \== File,
    \+ is_test(User),
    (   List == all
    ->  mentions(User, Name)
    ;   is_list(List),
        member(Import, List),
        imported_as(Import, Name/_, _)
    ),
    !.
used(File, PI) :-
    reexport(User, File, List),
    offered(File, List, PI),
    used_at(User, PI),
    !.
used(File, Name/Arity) :-
    module_of(File, Module),
    reaches(_, Module, Name/Arity),
    !.
used(File, Name/_) :-                   % started from a shell
    module_of(File, Module),
    mentions(User, Module),
    User \== File,
    mentions(User, Name),
    !.

used_at(Face, _) :-
    face(Face),
    !.
used_at(Interface, PI) :-
    used(Interface, PI).

is_test(File) :-
    inside('test/', Tests),
    atom_concat(Tests, _, File).

may_import(_, Target) :-
    \+ module_of(Target, _),
    !.
may_import(Layer, Target) :-
    layer_module(Target, Layer, _),
    !.
may_import(_, Target) :-
    layer_module(Target, 'kernel/base', _),
    !.
may_import(Layer, Target) :-
    interface(Target, Lower),
    layers(Layers),
    nth1(L, Layers, Lower),
    nth1(H, Layers, Layer),
    L < H,
    \+ ( is_option(Lower), is_option(Layer) ).

%   Options refer to each other by seams only; some share keys.

is_option(Layer) :-
    atom_concat('options/', Option, Layer),
    Option \== keys.

%   may_be_called(+File, +Module, +PI) is semidet: other modules may call
%   Module:PI, which File defines, or which Module inherits from `system`.

may_be_called(File, _, PI) :-
    export(File, PI),
    !.
may_be_called(File, _, PI) :-
    publishes(File, PI),
    !.
may_be_called(File, Module, PI) :-
    ( PI = (//)/2 ; declares(File, Module:PI) ),
    !.
may_be_called(_, _, Name/Arity) :-
    functor(Head, Name, Arity),
    predicate_property(system:Head, defined).

reaches_by_import(From, To) :-
    reaches_by_import(From, To, [From]).

reaches_by_import(From, To, _) :-
    next_module(From, To).
reaches_by_import(From, To, Seen) :-
    next_module(From, Next),
    Next \== To,
    \+ memberchk(Next, Seen),
    reaches_by_import(Next, To, [Next|Seen]).

next_module(From, To) :-
    layer_file(From, Layer),
    import(From, To, _),
    layer_file(To, Layer).

report(Problem) :-
    says(Problem, Format, Args0),
    maplist(short, Args0, Args),
    format(user_error, Format, Args),
    nl(user_error).

says(unused_import(F, T, PI), '~w: ~w of ~w is imported, and not used',
     [F, PI, T]).
says(unused_export(F, PI), '~w: no module uses its export ~w', [F, PI]).
says(unused_at_interface(F, PI), '~w: no module imports ~w from this interface', [F, PI]).
says(no_such_file(F, T), '~w: imports ~w, which is not there', [F, T]).
says(against_layers(F, T), '~w: imports ~w, against the layers', [F, T]).
says(past_interface(F, M, PI), '~w: calls ~w of ~w, which is internal',
     [F, PI, M]).
says(no_such_predicate(F, M, PI), '~w: names ~w of ~w, which is not there',
     [F, PI, M]).
says(circle(F), '~w: imports itself, in a circle', [F]).
says(time_of_day(F, wait), '~w: waits by the time of day, see \c
     kernel/base/monotonic.pl', [F]).
says(time_of_day(F, N), '~w: uses ~w, which goes by the time of day, see \c
     kernel/base/monotonic.pl', [F, N]) :-
    N \== wait.
says(other_json(F, L), '~w: imports library(~w), see bridges/json.pl',
     [F, L]).
says(stray_comment_end(F), '~w: a stray */ makes the next directive a clause',
     [F]).
says(breaks_rule(F, H), '~w: defines ~w of a higher layer', [F, H]) :-
    H = _:_.
says(breaks_rule(F, O), '~w: names the option ~w: use a hook', [F, O]) :-
    atom(O).
says(hook_not_declared(F, H), '~w: defines ~w, which its module does not \c
     declare multifile', [F, H]).
says(undeclared(F, Form, Term), '~w: handles the ~w ~q, which \c
     prolog/typhon/kernel/wire/kinds.pl does not declare for it', [F, Form, Term]).
says(not_handled(Module, Form, Term), 'prolog/typhon/kernel/wire/kinds.pl: no \c
     clause of ~w handles the ~w ~q', [Module, Form, Term]).
says(stale_kinds, 'doc/wire.md: its table of kinds is not what it is to be: run \c
     doc/layers.pl -- kinds', []).
says(stale_index(F), '~w: is not what it is to be: run doc/layers.pl -- index',
     [F]).
says(no_layer(F), '~w: belongs to no layer, see layers/1 in doc/layers/tree.pl',
     [F]).
says(needs_part(F, Used, Part), '~w: needs ~w of the part ~w, which may be \c
     left out, see app/packaging/parts.pl', [F, Used, Part]).
says(no_such_path(Part, Path), 'app/packaging/parts.pl: ~w of ~w is not there',
     [Path, Part]).
says(inherits(M), '~w does not inherit from system', [M]).
says(expanded(M, PI), '~w: a clause of ~w has a lambda expression or a function \c
     on dicts, see kernel/base/compiling.pl', [M, PI]).
says(not_imported(M, PI), '~w calls ~w, and does not import it', [M, PI]).
says(hook_without_definition(F, H), '~w: no module defines its hook ~w',
     [F, H]).

short(File, Short) :-
    atom(File),
    inside('', Root),
    atom_concat(Root, Short, File),
    !.
short(Term, Term).
