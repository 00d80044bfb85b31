:- module(typhon_options,
          [ check_options/2,            % +Domain, +Options
            check_option/2,             % +Domain, +Option
            check_name/2,               % +Domain, +Term
            options_load/2,             % +Domain, +Options
            blaming/2                   % +What, :Goal
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(error), [domain_error/2, is_of_type/2, must_be/2]).
:- use_module(library(solution_sequences), [distinct/2]).
:- use_module(index, [part_joins/3]).
:- use_module(on_demand, [on_demand_load/2]).
:- use_module(names,
              [names/2, names_joined/3, names_listed/2, names_proposed/3]).

/** <module> Unknown options are errors

Each list of options belongs to a domain, such as `host_option`. The module
that accepts the options declares them by clauses for

    declared(Domain, Option, Type, Value)

A declaration that is about an optional part alone is in a file of that part:
checking such an option loads the part. Type is that of Value, a part of
Option, as in must_be/2. If several clauses declare an option, one of them has
to accept it.

*Threading*: any thread.
*/

:- multifile
    declared/4,                 % Domain, Option, Type, Value
    typhon_names:known/2,
    prolog:error_message//1.

:- meta_predicate blaming(+, 0).

typhon_names:known(Domain, Name) :-
    declared(Domain, Option, _, _),
    functor(Option, Name, _).
typhon_names:known(Domain, Name) :-
    part_joins(Domain, Name, _).

%!  check_options(+Domain, +Options) is det.
%!  check_option(+Domain, +Option) is det.
%
%   @error type_error(list, Options), domain_error(Domain, Option), and errors
%          of must_be/2 for values

check_options(Domain, Options) :-
    must_be(list, Options),
    maplist(check_option(Domain), Options).

check_option(Domain, Option) :-
    must_be(callable, Option),
    functor(Option, Name, _),
    on_demand_load(Domain, Name),
    (   declared(Domain, Option, Type, Value),
        is_of_type(Type, Value)
    ->  true
    ;   wrong_option(Domain, Option)
    ).

wrong_option(Domain, Option) :-
    declared(Domain, Option, Type, Value),
    !,
    blaming(Option, must_be(Type, Value)).
wrong_option(Domain, Option) :-
    domain_error(Domain, Option).

%!  options_load(+Domain, +Options:list) is det.
%
%   Load the parts that define Options. check_option/2 does so, too.

options_load(Domain, Options) :-
    forall(( member(Option, Options), functor(Option, Name, _) ),
           on_demand_load(Domain, Name)).

%!  check_name(+Domain, +Term) is det.
%
%   If Term is bound, its name and arity exist in Domain. For terms such as
%   properties.
%
%   @error domain_error(Domain, Term)

check_name(_, Term) :-
    var(Term),
    !.
check_name(Domain, Term) :-
    (   callable(Term),
        functor(Term, Name, Arity),
        functor(General, Name, Arity),
        typhon_names:known(Domain, General)
    ->  true
    ;   domain_error(Domain, Term)
    ).

%!  blaming(+What, :Goal) is semidet.
%
%   As once(Goal); an error that it raises names What as the culprit.

blaming(What, Goal) :-
    catch(Goal, error(Formal, _), blame(Formal, What)),
    !.

blame(Formal, What) :-
    format(string(Text), 'in ~p', [What]),
    throw(error(Formal, context(_, Text))).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:error_message(domain_error(Domain, Culprit)) -->
    { atom(Domain),
      typhon_names:known(Domain, _),
      !,
      atomic_list_concat(Words, '_', Domain),
      atomic_list_concat(Words, ' ', Kind)
    },
    { culprit_name(Culprit, Name),
      names(Domain, Names),
      meant(Domain, Name, Names, Meant),
      names_listed(Names, All)
    },
    [ 'There is no ~w ~p~w~w'-[Kind, Culprit, Meant, All] ].

%   An option has that name: show its form.

meant(Domain, Name, _, Text) :-
    findall(Option,
            distinct(Option, ( declared(Domain, Option, _, _),
                               functor(Option, Name, _) )),
            Options),
    Options \== [],
    !,
    names_joined(Options, ' or ', Written),
    format(atom(Text), ' (write ~w)', [Written]).
meant(_, Name, Names, Text) :-
    names_proposed(Name, Names, Text).

%   Other libraries accept Name=Value; this one does not.

culprit_name(Name=_, Name) :-
    !.
culprit_name(Culprit, Name) :-
    callable(Culprit),
    !,
    functor(Culprit, Name, _).
culprit_name(_, none).
