:- use_module(common).
:- use_module(library(typhon)).
:- use_module(library(typhon/fipa)).

/*  Messages of FIPA per second, over HTTP: from an agent on one platform to
one on another of the same process, and back. */

:- initialization(main, main).

main([_]) :-
    host_start(here),
    host_start(there),
    fipa_start(here, 'http://127.0.0.1:0/acc', [queue(100000)]),
    fipa_start(there, 'http://127.0.0.1:0/acc', [queue(100000)]),
    once(fipa_property(there, url(Url))),
    one_way(Url, 500, _),               % warm up
    one_way(Url, 5000, OneWay),
    figure('FIPA messages per second, one way', OneWay, '1/s'),
    questions(Url, 2000, Answers),
    figure('FIPA questions and answers per second, one at a time', Answers,
           '1/s'),
    host_stop(here),
    host_stop(there).

one_way(Url, Count, Rate) :-
    agent_create(clauses([ (:- agent(counter, [state([left/1])])),
                           (main :- left(N), count(N)),
                           (count(0) :- !),
                           (count(N) :- receive(_), N1 is N-1, count(N1)) ]),
                 Counter, [host(there), facts([left(Count)])]),
    once(fipa_property(there, name(Counter, Name))),
    seconds(( agent_create(
                  clauses([ (:- agent(sender, [])),
                            (main :- forall(between(1, Count, N),
                                            send(fipa(Name, [Url]),
                                                 acl(inform, [content([n(N)])])))) ]),
                  _, [host(here)]),
              agent_join(Counter, done, 300) ),
            Seconds),
    Rate is Count/Seconds.

questions(Url, Count, Rate) :-
    agent_create(clauses([ (:- agent(answerer, [])),
                           (on_message(_, Acl) :- reply(Acl, inform, [yes])) ]),
                 Answerer, [host(there)]),
    once(fipa_property(there, name(Answerer, Name))),
    seconds(( agent_create(
                  clauses([ (:- agent(asker, [])),
                            (main :- ask(Count)),
                            (ask(0) :- !),
                            (ask(N) :-
                                 send(fipa(Name, [Url]),
                                      acl(request, [ content([n(N)]),
                                                     conversation_id(N) ])),
                                 receive(_-acl(inform, _)),
                                 N1 is N-1,
                                 ask(N1)) ]),
                  Asker, [host(here)]),
              agent_join(Asker, done, 300) ),
            Seconds),
    Rate is Count/Seconds.
