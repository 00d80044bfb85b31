:- module(test_fipa_agents,
          [ does/2,                     % +Goals, -Result
            does/3                      % +Goals, +Clauses, -Result
          ]).

/** <module> Agents that speak with platforms of FIPA

*Threading*: one test at a time.
*/

:- use_module(common, []).
:- use_module(library(typhon)).

%!  does(+Goals, -Result) is det.
%!  does(+Goals, +Clauses:list, -Result) is det.
%
%   Result is that of an agent on alpha which does Goals, knows how to ask and
%   to call for proposals, and may call Clauses.

does(Goals, Result) :-
    does(Goals, [], Result).

does(Goals, Clauses, Result) :-
    agent_create(clauses([ (:- agent(asker, [])),
                           (main :- attach(payloads(fipa/request)),
                                    attach(payloads(fipa/contract_net)),
                                    Goals, result(Result))
                         | Clauses ]),
                 Agent, [host(alpha)]),
    agent_result(Agent, Result, 150).
