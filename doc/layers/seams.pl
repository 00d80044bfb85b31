:- module(layers_seams,
          [ seam_problem/1,     % -Problem
            kernel_file/1       % ?File
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(index, [index_file/1]).
:- use_module(kinds, [kinds_file/1]).
:- use_module(tree).

/** <module> The kernel names no option

An option is a capability that a process may run without: a journal, keys,
quotas.  The kernel offers hooks, which options define; it does not name them.
A file names an option if a word of an atom or functor in its code is one of
the option's words; comments do not count.

Hooks are checked like imports.  Each is declared multifile by the module that
calls it, and a module may define the hooks of lower layers only.

*Threading*: the main thread.
*/

%!  option_words(?Option, ?Words) is nondet.

option_words(journal,  [journal, journaled, committing, ledger]).
option_words(snapshot, [snapshots]).   % snapshot/1 is Prolog's
option_words(tls,      [tls, secure, certificate, certificates]).
option_words(identity, [owner, owners, signed, signature, signatures,
                        authors, unseal]).
option_words(migration, [strategy, strategies, pheromone, pheromones,
                         next_host]).
option_words(trail,    [trail, trails, chain]).
option_words(guard,    [guard, guarded, guards]).
option_words(quotas,   [quota, quotas]).
option_words(cell,     [gatekeeper, walled]).
option_words(access,   [access_rules, audit, permits]).
option_words(virtual,  [virtual]).
option_words(watch,    [watch, watches, watched, watching]).
option_words(trace,    [trace, traces, traced, tracing, spying, stepping]).

%!  kernel_file(?File) is nondet.
%
%   File is of the kernel, but for the index and the declarations.

kernel_file(File) :-
    layer_module(File, Layer, _),
    sub_atom(Layer, 0, _, _, 'kernel/'),
    \+ index_file(File),                % these name them all: one is made, one
    \+ kinds_file(File),                % declares what may arrive, and one has
    file_base_name(File, Base),         % names of Prolog's predicates
    Base \== 'thread_state.pl'.

%!  seam_problem(-Problem) is nondet.

seam_problem(breaks_rule(File, What)) :-
    breaks_rule(File, What).
seam_problem(hook_not_declared(File, Hook)) :-
    defines(File, Hook),
    Hook = Module:_,
    module_of(Owner, Module),
    layer_file(Owner, _),
    \+ declares(Owner, Hook).
seam_problem(hook_without_definition(File, Hook)) :-
    declares(File, Hook),
    Hook = Module:PI,
    module_of(File, Module),
    layer_file(File, _),
    \+ defines(_, Hook),
    \+ defines_own(File, PI),
    \+ ( mentions(Test, Module), is_test(Test) ).

%!  breaks_rule(?File, ?What) is nondet.
%
%   What is the option that File names, or a hook of a higher layer that it
%   defines.

breaks_rule(File, Option) :-
    names_option(File, Option).
breaks_rule(File, Hook) :-
    defines(File, Hook),
    Hook = Module:_,
    module_of(Owner, Module),
    layer_file(Owner, Layer),
    layer_file(File, Definer),
    \+ not_above(Layer, Definer).

defines_own(File, PI) :-
    size(File, PI, _, _).

is_test(File) :-
    inside('test/', Tests),
    atom_concat(Tests, _, File).

not_above('kernel/base', _) :-
    !.
not_above(Layer, Definer) :-
    layers(Layers),
    once(( member(Lower, Layers), memberchk(Lower, [Layer, Definer]) )),
    Lower == Layer.

                /*******************************
                *       OPTIONS IN FILES       *
                *******************************/

names_option(File, Option) :-
    kernel_file(File),
    option_words(Option, Words),
    once(( mentions(File, Name), has_word(Name, Words) )).

has_word(Name, Words) :-
    memberchk(Name, Words),
    !.
has_word(Name, Words) :-
    atomic_list_concat(Parts, '_', Name),
    member(Part, Parts),
    memberchk(Part, Words),
    !.
