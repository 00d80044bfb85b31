:- module(test_kinds, []).

/** <module> Terms of other processes have their declared types and bounds

The terms are of kinds that need no right.

*Threading*: one test at a time.
*/

:- use_module('../../../lib/common').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon/kernel/wire/kinds), [arrival_verdict/5]).

verdict(Form, Kind, Term, Verdict) :-
    arrival_verdict(Form, Kind, Term, '127.0.0.1:1', Verdict).

post(Name, Count, Post) :-
    Post = channel(Name, to, first(0), Count, note, x).

name(Length, Name) :-
    format(atom(Name), '~`xt~*|', [Length]).

:- begin_tests(kinds).

test(names_have_65536_characters_at_most,
     [ forall(member(Length-Expected, [1-ok, 65536-ok, 65537-undeclared])),
       Verdict == Expected ]) :-
    name(Length, Name),
    post(Name, 0, Post),
    verdict(post, channel, Post, Verdict).
test(argument_of_another_type_is_refused,
     [ forall(member(Name-Count, [ "text"-0, _-0, 7-0, f(x)-0, n-(-1),
                                   n-1.0, n-_, n-zero ])),
       Verdict == undeclared ]) :-
    post(Name, Count, Post),
    verdict(post, channel, Post, Verdict).
test(lists_have_a_million_elements_at_most,
     [ forall(member(Length-Expected, [0-ok, 1000000-ok, 1000001-undeclared])),
       Verdict == Expected ]) :-
    length(List, Length),
    verdict(post, whereabouts, List, Verdict).
test(term_that_is_no_list_is_refused,
     [ forall(member(Term, [_, [x|_], [x|y], list])), Verdict == undeclared ]) :-
    verdict(post, whereabouts, Term, Verdict).
test(other_form_kind_or_arity_is_refused,
     [ forall(member(Form-Kind-Term,
                     [ request-channel-again(to), hand-channel-again(to),
                       post-no_such_kind-again(to), post-_-again(to),
                       post-channel-again(to, x), post-channel-again,
                       post-channel-_ ])),
       Verdict == undeclared ]) :-
    verdict(Form, Kind, Term, Verdict).

:- end_tests(kinds).
