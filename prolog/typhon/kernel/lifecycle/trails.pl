:- module(typhon_trails,
          [ agent_trail/2               % +Agent, -Trail
          ]).
:- use_module('../agent', [agent/5, trail_of/3, trail_verified/3]).
:- use_module(order_client, [agent_answer/3]).
:- use_module(questions, [question_answered/2]).

/** <module> Which hosts can be accounted for

*Threading*: any thread.
*/

:- multifile typhon_questions:here/3.

%!  agent_trail(+Agent, -Trail) is det.
%
%   Trail is trail(Steps, Verdict): which hosts have had Agent since it first
%   left its process, with the keys of this process. A step is
%   step(N, Name, What): the host with the certificate of that Name has signed
%   that it was handed(To), received(At), or has entered(Result). Verdict is
%   `whole`, or unaccounted(Name): after that host, or in its hands, state or
%   code have changed without a signature; of what came later there are no
%   steps; or since(N), if all is well from the N-th link on, and those before
%   are gone. Without keys on its way an agent has no steps.
%
%   @error existence_error(agent, Agent)
%   @error existence_error(keys, here)

agent_trail(Agent, Trail) :-
    agent_answer(Agent, trail, Raw),
    trail_verified(Agent, Raw, Trail).

typhon_questions:here(trail, Agent, Asker) :-
    agent(Agent, _, Module, _, _),
    !,
    trail_of(Module, Agent, Raw),
    question_answered(Asker, answer(Raw)).
