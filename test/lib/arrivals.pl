:- module(test_lib_arrivals,
          [ arrival_sample/6            % +Host, +Agent, -Form, -Kind, -Term,
                                        % -Right
          ]).

/** <module> Terms that another process may send, one of each declaration

*Threading*: any thread.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(typhon/kernel/wire/kinds), [arrives/6]).

%!  arrival_sample(+Host, +Agent, -Form, -Kind, -Term, -Right) is nondet.
%
%   Term is a `post` or `request` of Kind, about Host, a name, or Agent where the
%   declaration is about a host or an agent, for which Right is needed.

arrival_sample(Host, Agent, Form, Kind, Term, Right) :-
    arrives(Form0, Kind, Pattern, Right, Scope, _),
    about(Scope, Host, Agent),
    sample(Pattern, Term0),
    framed(Form0, Form, Term0, Term).

about(host(Host), Host, _) :-
    !.
about(agent(Agent), _, Agent) :-
    !.
about(_, _, _).

framed(post, post, Term, Term).
framed(request, request, Term, Term).
framed(news, post, Term, [Term]).

sample(Var:Type, Term) :-
    !,
    ( nonvar(Var) -> Term = Var ; sample(Type, Term) ).
sample(list(_), Term) :-
    !,
    Term = [].
sample(Type, Term) :-
    of_type(Type, Term0),
    !,
    Term = Term0.
sample(Pattern, Term) :-
    compound(Pattern),
    !,
    compound_name_arguments(Pattern, Name, Types),
    maplist(sample, Types, Args),
    compound_name_arguments(Term, Name, Args).
sample(Constant, Constant).

of_type(name, x).
of_type(term, true).
of_type(count, 0).
of_type(positive, 1).
of_type(number, 1).
