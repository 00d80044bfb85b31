:- module(test_kinds, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon/kernel/wire/kinds),
              [arrival_permitted/4, arrival_verdict/5, arrives/6]).

/** <module> Terms of other processes against the declarations

The hook that decides about rights is one of this test.

*Threading*: one test at a time.
*/

:- dynamic
    may/1,                              % Right
    asked/3.                            % Right, Scope, Peer

typhon_kinds:peer_permitted(Right, Scope, _, Peer) :-
    assertz(asked(Right, Scope, Peer)),
    may(Right).

:- meta_predicate asking(+, 0, -).

asking(Rights, Goal, Asked) :-
    retractall(asked(_, _, _)),
    setup_call_cleanup(
        forall(member(Right, Rights), assertz(may(Right))),
        once(Goal),
        retractall(may(_))),
    findall(R-S, asked(R, S, peer), Asked).

atom_of(N, Atom) :-
    length(Codes, N),
    maplist(=(0'x), Codes),
    atom_codes(Atom, Codes).

%   carries(+Type, ?Term, -Form, -Kind, -Carrier): Carrier is declared if Term is
%   of Type.

carries(name, T, request, agent, question(T, properties)).
carries(term, T, request, remote, remote(h, T)).
carries(count, T, post, message, message(a, [], T)).
carries(positive, T, post, pheromone,
        pheromone(h, smelt(a, signal(x, b, 1, T, 1.5, 0, 2)))).
carries(number, T, post, pheromone,
        pheromone(h, smelt(a, signal(x, b, 1, 1, T, 0, 2)))).
carries(list(name), T, request, watch, watch(x, T)).
carries(pair, T, post, message, T).

is_of(Type, Term, Is) :-
    carries(Type, Term, Form, Kind, Carrier),
    arrival_verdict(Form, Kind, Carrier, peer, Verdict),
    ( Verdict == undeclared -> Is = no ; Is = yes ).

:- begin_tests(kinds).

test(arguments_have_their_types, Deviations == []) :-
    findall(Type-Term, ( case(Type, Term, Expected),
                         is_of(Type, Term, Is),
                         Is \== Expected ), Deviations).
test(names_have_at_most_65536_characters, Are == [yes,no]) :-
    findall(Is, ( member(N, [65 536,65 537]), atom_of(N, A),
                  is_of(name, A, Is) ), Are).
test(lists_have_at_most_a_million_elements, Are == [yes,no]) :-
    findall(Is, ( member(N, [1 000 000,1 000 001]), length(L, N),
                  maplist(=(a), L), is_of(list(name), L, Is) ), Are).
test(declared_terms_are_accepted, [forall(accepted(F, K, T)), Verdict == ok]) :-
    asking([watch,orders,messages,agents,remote,parent],
           arrival_verdict(F, K, T, peer, Verdict), _).
test(other_terms_are_not_declared,
     [forall(undeclared(F, K, T)),
      Verdict-Asked == undeclared-[undeclared(K)-all]]) :-
    asking([watch,undeclared(K)], arrival_verdict(F, K, T, peer, Verdict),
           Asked).
test(terms_need_their_right_on_their_hosts,
     [ forall(needs(F, K, T, Right, Scope)),
       [Without,With]-Asked == [refused(Right),ok]-[Right-Scope] ]) :-
    asking([], arrival_verdict(F, K, T, peer, Without), Asked),
    asking([Right], arrival_verdict(F, K, T, peer, With), _).
test(some_terms_need_no_right,
     [forall(free(F, K, T)), Verdict-Asked == ok-[]]) :-
    asking([], arrival_verdict(F, K, T, peer, Verdict), Asked).
test(only_permitted_terms_are_permitted, Permitted == [yes,no,no]) :-
    findall(P, ( member(Rights-T, [[watch]-properties, []-properties,
                                   [watch]-bogus]),
                 asking(Rights, ( arrival_permitted(request, agent,
                                                    question(a, T), peer)
                                -> P = yes ; P = no ), _) ), Permitted).

%   Rights of rules, and those that need none.

test(each_right_is_one_of_the_documented, Rights ==
     [agents,asked,gate,log,messages,none,orders,parent,remote,watch]) :-
    findall(R, arrives(_, _, _, R, _, _), Rights0),
    sort(Rights0, Rights).
test(terms_without_a_right_are_few,
     Free == [ hand-hop, post-again, post-channel,
     post-had, post-whereabouts, request-agent, request-alive, request-arrived,
     request-events, request-hop, request-of_yours, request-traced,
     request-unwatch ]) :-
    findall(F-N, ( arrives(F, K, P, R, _, _), memberchk(R, [none,asked,gate]),
                   F \== order,
                   ( K == agent -> N = agent ; K == whereabouts -> N = K
                   ; K == hop -> N = K
                   ; compound(P) -> functor(P, N, _) ; N = P ) ), Free0),
    sort(Free0, Free).

:- end_tests(kinds).

case(name, x, yes).
case(name, [], no).
case(name, "x", no).
case(name, 1, no).
case(name, _, no).
case(term, _, yes).
case(term, f(_), yes).
case(count, 0, yes).
case(count, -1, no).
case(count, 1.0, no).
case(positive, 1, yes).
case(positive, 0, no).
case(positive, 1.5, no).
case(number, -1.5, yes).
case(number, x, no).
case(list(name), [], yes).
case(list(name), [a,b], yes).
case(list(name), [a,"b"], no).
case(list(name), [a|_], no).
case(list(name), a, no).
case(pair, message(a, [], 1), yes).
case(pair, message(a, [], x), no).
case(pair, message("a", [], 1), no).
case(pair, massage(a, [], 1), no).
case(pair, message(a, []), no).
case(pair, _, no).

accepted(request, agent, question(a, properties)).
accepted(request, agent, question(a, order(attach(_)))).
accepted(post, message, message(a, [mail(x, f(y), z)], 0)).
accepted(post, pheromone,
         pheromone(h, smelt(a, signal(x, b, 1, 1, 1.5, 0, 2)))).
accepted(request, watch, watch(x, all)).
accepted(request, watch, watch(x, [a,b])).
accepted(request, monitor, by(a, begin(b, false))).
accepted(request, monitor, by(a, begin(b, self))).
accepted(request, remote, remote(h, _)).
accepted(order, node, hosts([a-[x]])).

undeclared(request, agent, question("a", properties)).
undeclared(request, agent, question(a, properties(x))).
undeclared(request, agent, question(a, order(bogus))).
undeclared(request, agent, question(_, properties)).
undeclared(request, agent, _).
undeclared(request, bogus, x).
undeclared(post, agent, question(a, properties)).
undeclared(hand, agent, question(a, properties)).
undeclared(post, message, message(a, [mail("x", y, z)], 0)).
undeclared(post, message, message(a, [mail(x, y)], 0)).
undeclared(post, message, message(a, [], -1)).
undeclared(post, pheromone,
           pheromone(h, smelt(a, signal(x, b, 1, 0, 1.5, 0, 2)))).
undeclared(request, watch, watch(x, some)).
undeclared(request, watch, watch(x, [a|_])).
undeclared(request, f(x), x).
undeclared(order, node, hosts([a-x])).

needs(request, agent, question(a, properties), watch, agent(a)).
needs(request, agent, question(a, step), orders, agent(a)).
needs(request, agent, question(a, order(move(b))), orders, agent(a)).
needs(request, agent, question(a, order(image)), orders, agent(a)).
needs(post, message, message(a, [], 0), messages, agent(a)).
needs(post, message, shown(x, message(a, [], 0)), messages, agent(a)).
needs(post, message, lost(x, y, []), messages, all).
needs(news, whereabouts, located(a, b, 1), agents, agent(a)).
needs(news, whereabouts, ended(a, done, 1), agents, agent(a)).
needs(request, join, join(a, x), watch, agent(a)).
needs(request, remote, remote(h, true), remote, host(h)).
needs(request, hosting, hosts, watch, some).
needs(request, hosting, link(h, i), orders, host(h)).
needs(request, hosting, unlink(h, i), orders, host(h)).
needs(request, survey, look(0), watch, all).
needs(post, pheromone, pheromone(h, withdrawn(a, x)), messages, host(h)).
needs(request, watch, watch(x, all), watch, some).
needs(post, log, event(a, b, c, d), log, all).
needs(request, monitor, by(a, begin(b, false)), agents, agent(a)).
needs(request, monitor, by(a, begin(b, c)), orders, agent(b)).
needs(request, monitor, end([a], [b]), orders, all).
needs(request, node, order(secret, x), parent, none).

free(hand, hop, hop(a, b, c)).
free(request, hop, hop(a, b, c)).
free(request, certificate, of_yours).
free(request, watched, events(x, [])).
free(post, whereabouts, [x]).
