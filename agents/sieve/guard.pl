:- agent(guard, [state([setting/2, application/1, cells/1])]).
:- include(parameters).
:- include('../lib/keep').
:- include('../lib/chance').
:- include(idiotypic).

/*  The guard of a host, a static agent.  At the message attack(Antigen) it
    emits a danger signal, gathers antibodies that arrive, different ones
    only, has one of them neutralize the antigen, and lets all of them
    stimulate and suppress each other (thesis section 3.4).  If none arrives,
    the guard generates one at random, and releases it as a new agent.
    It handles attacks one after the other.

    Facts: application(Spec), the payload for new agents, which the guard
    carries, too; cells(Count), the number of memory cells it has appointed.

    On the host: guard(Id), left by the program that started the guard;
    attacked(Attack, Id) while the guard accepts offers.  An attack is
    attack(Antigen, Host, Number), which is also the problem of its danger
    signal: so each agent follows only the signals it wants.
*/

main :-
    seed_chance_here,
    keep(cells(0)),
    watch(1).

watch(Number) :-
    receive(From-What),
    watch(What, From, Number).

watch(attack(Antigen), _, Number) :-
    !,
    here(Host),
    Attack = attack(Antigen, Host, Number),
    log(attacked(Antigen)),
    now(Begin),
    call_for_help(Attack, Offers),
    (   settle(Offers, Attack, Begin)
    ->  true
    ;   log(unanswered(Antigen))        % no antibody has enough affinity
    ),
    Number1 is Number + 1,
    watch(Number1).
watch(offer(Attack, _, _, _, _), From, Number) :-
    !,
    send(From, reply(Attack, over)),
    watch(Number).
watch(_, _, Number) :-
    watch(Number).

                /*******************************
                *            OFFERS            *
                *******************************/

%   call_for_help(+Attack, -Offers): Offers are Agent-Offer.

call_for_help(Attack, Offers) :-
    self(Me),
    leave(attacked(Attack, Me)),
    parameter(calls, Calls),
    call_for_help(Calls, Attack, Offers),
    ignore(take(attacked(Attack, Me))),
    withdraw(Attack).

call_for_help(0, _, Offers) :-
    !,
    Offers = [].
call_for_help(Calls, Attack, Offers) :-
    parameter(span, Span),
    parameter(patience, Patience),
    Period is Patience/Span,
    emit(Attack, [span(Span), period(Period)]),
    (   receive(Agent-offer(Attack, Antibody, Gamma, Memory, Wins), Patience)
    ->  now(Now),
        parameter(gather, Gather),
        Until is Now + Gather,
        Offer = offer(Attack, Antibody, Gamma, Memory, Wins),
        gather(Attack, Until, [Agent-Offer], Offers)
    ;   Calls1 is Calls - 1,
        call_for_help(Calls1, Attack, Offers)
    ).

gather(Attack, Until, Offers0, Offers) :-
    now(Now),
    Left is max(0, Until - Now),
    (   receive(Agent-offer(Attack, Antibody, Gamma, Memory, Wins), Left)
    ->  Offer = offer(Attack, Antibody, Gamma, Memory, Wins),
        admit(Agent, Offer, Offers0, Offers1),
        gather(Attack, Until, Offers1, Offers)
    ;   Offers = Offers0
    ).

admit(Agent, offer(Attack, Antibody, _, _, _), Offers, Offers) :-
    memberchk(_-offer(_, Antibody, _, _, _), Offers),
    !,
    send(Agent, reply(Attack, redundant)).
admit(Agent, Offer, Offers, [Agent-Offer|Offers]).

                /*******************************
                *            SERVICE           *
                *******************************/

settle([], Attack, Begin) :-
    !,
    generate(Attack, Begin).
settle(Offers, Attack, Begin) :-
    Attack = attack(Antigen, _, _),
    select_one(Offers, Antigen, Winner),
    memberchk(Winner-offer(_, Antibody, _, _, _), Offers),
    feedback(Antigen, Antibody, Xi),
    now(Now),
    Wait is Now - Begin,
    length(Offers, Kinds),
    log(served(Antigen, Antibody, Wait, Kinds)),
    cells(Offers, Winner, Antigen, Xi, Cells),
    parameter(reading, Reading),
    parameter(kt, Kt),
    parameter(ku, Ku),
    interaction(Reading, Antigen, Kt-Ku, Cells, Gammas),
    tell(Offers, Cells, Gammas, Winner).

select_one(Offers, Antigen, Winner) :-
    findall(Psi-Agent,
            ( member(Agent-offer(_, Antibody, _, _, _), Offers),
              affinity(Antigen, Antibody, Psi) ),
            Weighted),
    chance_turn(Turn),
    roulette(Weighted, Turn, Winner).

%   Memories and potentials of the agents when their interaction begins.

cells([], _, _, _, []).
cells([Agent-offer(_, _, Gamma0, Memory0, _)|Offers], Winner, Antigen, Xi,
      [cell(Agent, Gamma, Memory)|Cells]) :-
    (   Agent == Winner
    ->  parameter(alpha, Alpha),
        parameter(beta, Beta),
        squashed(Xi, Alpha, Beta, Squashed),
        stimulated(Gamma0, Squashed, Gamma),
        learnt(Memory0, Antigen, Xi, Memory)
    ;   Gamma = Gamma0,
        Memory = Memory0
    ),
    cells(Offers, Winner, Antigen, Xi, Cells).

tell([], [], [], _).
tell([Agent-Offer|Offers], [cell(_, _, Memory)|Cells], [Gamma|Gammas],
     Winner) :-
    Offer = offer(Attack, _, _, _, Wins0),
    (   Agent == Winner
    ->  Wins is Wins0 + 1,
        appoint(Wins, Cell)
    ;   Wins = Wins0,
        Cell = false
    ),
    send(Agent, reply(Attack, outcome(Gamma, Memory, Wins, Cell))),
    tell(Offers, Cells, Gammas, Winner).

%   A host appoints a limited number of memory cells, so their total number is
%   limited, too.

appoint(Wins, true) :-
    parameter(memory_wins, Enough),
    Wins >= Enough,
    parameter(memory_cells, Most),
    cells(Count),
    Count < Most,
    !,
    Count1 is Count + 1,
    keep(cells(Count1)).
appoint(_, false).

                /*******************************
                *          GENERATION          *
                *******************************/

%   A random antibody neutralizes the antigen, and is released as a new agent.
%   Fails if none with enough affinity is found.

generate(attack(Antigen, Host, _), Begin) :-
    chance(Chance0),
    parameter(draws, Draws),
    draw(Draws, Antigen, Drawn, Chance0, Chance),
    keep(chance(Chance)),
    Drawn = suitable(Antibody),
    feedback(Antigen, Antibody, Xi),
    now(Now),
    Wait is Now - Begin,
    log(generated(Antigen, Antibody, Wait)),
    release(Host, Antibody, [Antigen-Xi]).

draw(0, _, Drawn, Chance, Chance) :-
    !,
    Drawn = nothing.
draw(Draws, Antigen, Drawn, Chance0, Chance) :-
    random_antibody(Chance0, Antibody, Chance1),
    affinity(Antigen, Antibody, Psi),
    affinity_threshold(Threshold),
    (   Psi >= Threshold
    ->  Drawn = suitable(Antibody),
        Chance = Chance1
    ;   Draws1 is Draws - 1,
        draw(Draws1, Antigen, Drawn, Chance1, Chance)
    ).

release(Host, Antibody, Memory) :-
    application(Application),
    parameter(gamma, Gamma),
    parameter(expiry, Expiry),
    findall(setting(Name, Value), setting(Name, Value), Settings),
    catch(( typhon:agent_create(agents(sieve/antibody), _,
                                [ host(Host), payloads([Application]),
                                  facts([ antibody(Antibody), gamma(Gamma),
                                          memory(Memory), wins(0),
                                          expiry(Expiry), shunned([])
                                        | Settings
                                        ])
                                ]),
            log(born(host, Antibody))
          ),
          error(move_refused(_, Reason), _),
          log(not_released(Reason, Antibody))).
