:- module(typhon_allowed,
          [ allowed/3,                  % +Policy, +Goal, -How
            allowed_library/1,          % +Library
            refuses/2,                  % +Policy, @Goal
            own_name/1,                 % +Head
            definable/1,                % +Head
            policy_read/1               % +Policy
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module('../../kernel/program',
              [control_of_system/1, control_written/2, vocabulary_word/2]).
:- use_module(constructs, [construct/2]).

/** <module> Predicates that untrusted agents may call

The check uses the name alone, so that its result is the same on every host.
The allowed predicates are

  - those that library(sandbox) considers safe for all arguments, except those
    that could still reach another agent, the process or its measurements
  - the vocabulary of agents
  - the predicates of some libraries without state, which a program gets with
    the vocabulary, or imports

*Threading*: any thread; a mutex protects the tables, which the first
policy_read/1 fills.
*/

:- dynamic
    seen_own/1,                 % Head: own_name/1 is true of it; bounded
    rule/3,                     % Head, Policy, allow or refuse
    free/1,                     % Head
    runs/2.                     % Head, Spec: runs goals; meta_predicate/1

%!  allowed(+Policy, +Goal, -How) is semidet.
%
%   Goal may be called if no rule refuses it, see refuses/2.  Policy is
%   `guarded`, or a file that policy_read/1 has read.
%
%   @arg How is `free`, runs(Spec) if Goal calls some of its arguments, or
%        look(Kind) if it depends on what these are

allowed(_, Goal, How) :-
    needs_check(Goal, Kind),
    !,
    How = look(Kind).
allowed(_, Goal, How) :-
    runs(Goal, Spec),
    !,
    How = runs(Spec).
allowed(_, Goal, free) :-
    free(Goal),
    !.
allowed(Policy, Goal, free) :-
    rule(Goal, Policy, allow).

%!  refuses(+Policy, @Goal) is semidet.
%
%   A rule of Policy refuses Goal, whether it is a construct, a control
%   predicate, or a service.  What a control predicate becomes when an agent
%   stops is refused as that, and move/2 is refused as move/1, too.

refuses(Policy, Goal) :-
    rule(Goal, Policy, refuse),
    !.
refuses(Policy, move(Host, _)) :-
    rule(move(Host), Policy, refuse),
    !.
refuses(Policy, Goal) :-
    control_written(Goal, Written),
    rule(Written, Policy, refuse).

%   needs_check(?Goal, ?Kind): the safety of Goal depends on its arguments,
%   which typhon_guard_calls checks as Kind demands.

needs_check(assert(_), clause).
needs_check(asserta(_), clause).
needs_check(assertz(_), clause).
needs_check(retract(_), pattern).
needs_check(retractall(_), head).
needs_check(clause(_, _), head).
needs_check(throw(_), ball).
needs_check(format(_, _, _), format).
needs_check(attach(_), payload).
needs_check(functor(_, _, _), size(3)).
needs_check(functor(_, _, _, _), size(3)).
needs_check(compound_name_arity(_, _, _), size(3)).
needs_check(length(_, _), size(2)).
needs_check(Goal, text) :-
    makes_atoms(Goal).
needs_check(term_to_atom(_, _), term_text).
needs_check(term_string(_, _), term_text).
needs_check(atom_to_term(_, _, _), term_text).

%   makes_atoms(?Goal): Goal makes atoms whose length grows with its arguments.

makes_atoms(atom_concat(_, _, _)).
makes_atoms(atomic_list_concat(_, _)).
makes_atoms(atomic_list_concat(_, _, _)).
makes_atoms(atomics_to_string(_, _, _)).
makes_atoms(atom_codes(_, _)).
makes_atoms(atom_chars(_, _)).
makes_atoms(atom_string(_, _)).
makes_atoms(atom_number(_, _)).
makes_atoms(upcase_atom(_, _)).
makes_atoms(downcase_atom(_, _)).
makes_atoms(sub_atom(_, _, _, _, _)).
makes_atoms(sub_atom_icasechk(_, _, _)).
makes_atoms(hash_atom(_, _)).
makes_atoms(file_base_name(_, _)).
makes_atoms(file_directory_name(_, _)).
makes_atoms(file_name_extension(_, _, _)).
makes_atoms(uri_components(_, _)).
makes_atoms(uri_authority_components(_, _)).
makes_atoms(uri_query_components(_, _)).
makes_atoms(uri_encoded(_, _, _)).
makes_atoms(uri_is_global(_)).
makes_atoms(uri_iri(_, _)).
makes_atoms(uri_normalized(_, _)).
makes_atoms(uri_normalized(_, _, _)).
makes_atoms(uri_normalized_iri(_, _)).
makes_atoms(uri_normalized_iri(_, _, _)).
makes_atoms(uri_resolve(_, _, _)).
makes_atoms(iri_normalized(_, _)).
makes_atoms(iri_normalized(_, _, _)).

%   Predicates that library(sandbox) allows and Typhon does not: they end or
%   block a thread, write to the user's terminal, call code that messages and
%   formats name, read data that others keep in the thread, or reveal facts of
%   the machine.

withheld(Head) :-
    functor(Head, Name, Arity),
    memberchk(Name/Arity,
              [ abort/0, writeln/1, print_message/2,
                message_to_string/2, format_time/3, format_time/4,
                normalize_space/2, b_getval/2, nb_getval/2, nb_current/2,
                abolish_all_tables/0, thread_self/1, statistics/2,
                is_stream/1, blob/2, current_prolog_flag/2, current_op/3,
                import_module/2, strip_module/3, current_type/3,
                variant_sha1/2, variant_hash/2, % endless for shared subterms
                name/2, atomic_concat/3, get_attr/3, get_attrs/2, del_attr/2,
                del_attrs/1, copy_term/3,
                setarg/3,               % checked terms must not change
                b_set_dict/3, nb_setarg/3, nb_linkarg/3, nb_set_dict/3,
                nb_link_dict/3, dcg_translate_rule/2,
                set_random/1,           % its state is global
                setrand/1, getrand/1, random_property/1,
                meta_options/3,         % options that are goals
                foreach/2,
                term_string/3,          % with options
                deliver/1, undeliver/1, % all agents on the host would call it
                seal/3, unseal/2,       % use the keys of the process
                (\)/1, (\)/2, (^)/2 ]),
    !.
withheld(Head) :-
    control_of_system(Head),
    !.
withheld(Head) :-
    functor(Head, Name, _),
    sub_atom(Name, 0, _, _, $).

%   System predicates that run goals.  `^` in a specification is a goal below
%   variables.

runs_of_system(findall(?, 0, -)).
runs_of_system(findall(?, 0, -, ?)).
runs_of_system(findnsols(+, ?, 0, -)).
runs_of_system(forall(0, 0)).
runs_of_system(bagof(?, ^, -)).
runs_of_system(setof(?, ^, -)).
runs_of_system(aggregate_all(?, 0, -)).
runs_of_system(aggregate_all(?, ?, 0, -)).

%!  allowed_library(?Library) is nondet.
%
%   Programs of untrusted agents may import Library.

allowed_library(library(Name)) :-
    member(Name, [ aggregate, apply, assoc, error, lists, option, ordsets,
                  pairs, random, solution_sequences, ugraphs, rbtrees,
                  heaps, yall ]).

%!  own_name(+Head) is semidet.
%
%   An agent may have a dynamic predicate with this name: while it does not
%   exist, its name leads to no predicate that agents must not call.

own_name(Head) :-
    functor(Head, Name, Arity),
    functor(General, Name, Arity),
    (   seen_own(General)
    ->  true
    ;   is_own(General),
        remember(General)
    ).

%!  definable(+Head) is semidet.
%
%   A clause may have this head: a goal of that name calls the clause, and the
%   name is not reserved for the platform.

definable(Head) :-
    functor(Head, Name, _),
    \+ makes_clause(Head),
    \+ construct(Head, _),
    \+ sub_atom(Name, 0, _, _, $),
    \+ sub_atom(Name, 0, _, _, 'mobile ').

%   makes_clause(?Head): assertz/1, or the reader, takes a fact with this head
%   for a clause of another predicate.

makes_clause((:-_)).
makes_clause((_:-_)).
makes_clause((_=>_)).
makes_clause(?=>(_, _)).
makes_clause((_-->_)).
makes_clause(?-(_)).

remember(General) :-
    (   predicate_property(seen_own(_), number_of_clauses(Count)),
        Count > 5000
    ->  retractall(seen_own(_))
    ;   true
    ),
    assertz(seen_own(General)).

is_own(Head) :-
    definable(Head),
    (   \+ predicate_property(typhon_vocabulary:Head, visible)
    ->  true
    ;   free(Head)
    ).

%!  policy_read(+Policy) is det.
%
%   Policy is `guarded`, or a file of rules, allow(Name/Arity) and
%   refuse(Name/Arity): predicates that untrusted agents may call as well, and
%   predicates that they may not call.
%
%   @error existence_error(source_sink, File), domain_error(policy_rule, Term)

policy_read(Policy) :-
    with_mutex(typhon_policies, fill),
    rules_read(Policy).

rules_read(guarded) :-
    !.
rules_read(File) :-
    \+ exists_file(File),
    !,
    throw(error(existence_error(source_sink, File),
                context(_, 'a policy is trusted, guarded or a file of rules'))).
rules_read(File) :-
    read_file_to_terms(File, Rules,
                       [ encoding(utf8), module(typhon_allowed_libraries) ]),
    maplist(policy_rule, Rules, Heads),
    with_mutex(typhon_policies,
               ( retractall(rule(_, File, _)),
                 forall(member(Head-Kind, Heads),
                        assertz(rule(Head, File, Kind))) )).

policy_rule(Rule, Head-Kind) :-
    (   ground(Rule),
        Rule =.. [Kind,Name/Arity],
        memberchk(Kind, [allow,refuse]),
        atom(Name),
        integer(Arity)
    ->  functor(Head, Name, Arity)
    ;   domain_error(policy_rule, Rule)
    ).

                /*******************************
                *          THE TABLES          *
                *******************************/

%   free_head(-Head) is nondet.  Rules of library(sandbox) for other libraries
%   than those below are left out: agents see these libraries only if the
%   process has loaded them.

free_head(Head) :-
    clause(sandbox:safe_primitive(Said), true),
    head_of(Said, Head),
    \+ \+ predicate_property(system:Head, defined).
free_head(Head) :-
    vocabulary_word(_, Name/Arity),
    functor(Head, Name, Arity),
    \+ predicate_property(typhon_vocabulary:Head, meta_predicate(_)).
free_head(Head) :-
    library_head(_, Head),
    \+ predicate_property(typhon_vocabulary:Head, meta_predicate(_)).

head_of(Said, _) :- var(Said), !, fail.
head_of(Module:Head, Head) :- !, memberchk(Module, [system, crypto_hash, uri]).
head_of(Head, Head).

library_head(Module, Head) :-
    allowed_library(Library),
    use_module(typhon_allowed_libraries:Library),
    absolute_file_name(Library, File, [file_type(prolog), access(read)]),
    module_property(Module, file(File)),
    module_property(Module, exports(PIs)),
    member(Name/Arity, PIs),
    functor(Head, Name, Arity).

runs_head(Head, Spec) :-
    runs_of_system(Spec),
    functor(Spec, Name, Arity),
    functor(Head, Name, Arity).
runs_head(Head, Spec) :-
    library_head(Module, Head),
    Module \== yall,
    predicate_property(Module:Head, meta_predicate(Spec)),
    \+ ( arg(_, Spec, Mode), memberchk(Mode, [:, //]) ).

fill :-
    free(_),
    !.
fill :-
    use_module(library(sandbox), []),
    forall(( runs_head(Head, Spec), \+ withheld(Head), \+ runs(Head, _) ),
           assertz(runs(Head, Spec))),
    forall(( free_head(Head), \+ withheld(Head), \+ runs(Head, _),
             \+ needs_check(Head, _), \+ free(Head) ),
           assertz(free(Head))).
