% Two platforms of FIPA, and a contract.    swipl examples/fipa.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- use_module('../prolog/typhon/fipa').
:- initialization(main, main).

main :-
    host_start(shop),
    host_start(street),
    fipa_start(shop, 'http://127.0.0.1:0/acc', []),
    fipa_start(street, 'http://127.0.0.1:0/acc', []),
    once(fipa_property(street, url(Url))),
    mender(ada, 9),
    mender(bob, 7),
    caller(Caller),
    agent_create(Caller, Agent, [host(shop), facts([street(Url)])]),
    agent_join(Agent, done, 20).

mender(Name, Price) :-
    agent_create(clauses(
        [ (:- agent(mender, [])),
          (main :- attach(payloads(fipa/participant))),
          (on_message(_, Acl) :- fipa_take_part(Acl)),
          (bid(mend(lamp), [euro(Price)]) :- true),
          (perform(mend(lamp), done) :- true)
        ]), _, [host(street), name(Name)]).

caller(clauses(
    [ (:- agent(caller, [state([street/1])])),
      (main :-
           attach(payloads(fipa/contract_net)),
           street(Url),
           Ada = fipa('ada@street', [Url]),
           Bob = fipa('bob@street', [Url]),
           fipa_call([Ada, Bob], [action(Ada, mend(lamp))], 10, Offers),
           msort(Offers, [[euro(Price)]-Acl|_]),
           fipa_award(Offers, [euro(Price)]-Acl, 10, Performative-_),
           format("~w for ~w euro~n", [Performative, Price]))
    ])).
