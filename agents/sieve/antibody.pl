:- agent(antibody, [state([setting/2, antibody/1, gamma/1, memory/1, wins/1,
                           expiry/1, shunned/1])]).
:- include(parameters).
:- include('../lib/keep').
:- include('../lib/clones').
:- include(idiotypic).

/*  A mobile agent that carries an antibody: a solution to some problems
    (thesis chapter 3).  It patrols the network, follows the danger signals of
    antigens that its antibody can neutralize, and offers it to the guard of
    the host under attack.  The guard sends it the result.

    Facts: antibody(Antibody); gamma(Gamma), its endurance potential;
    memory(Memory), the antigens it has neutralized, with the feedback;
    wins(Count), the number of attacks for which a guard chose it;
    expiry(Hops), the number of hops at which it dies, `inf` unless it is a
    clone; shunned(Attacks), attacks that do not need it.  Its payload is the
    application: affinity/3 and affinity_threshold/1.

    An agent with expiry(never) is a memory cell: it dies neither of age nor
    of suppression.
*/

main :-
    attend,
    travel,
    age,
    main.

                /*******************************
                *            ATTACKS           *
                *******************************/

%   A guard may have ended and left its tuples.

attend :-
    sense(attacked(Attack, Guard)),
    wanted(Attack),
    !,
    offer(Attack, Offer),
    send(Guard, Offer),
    (   receive(Guard-reply(Attack, Reply), 60)
    ->  heed(Reply, Attack)
    ;   shun(Attack)
    ).
attend.

wanted(Attack) :-
    Attack = attack(Antigen, _, _),
    shunned(Attacks),
    \+ memberchk(Attack, Attacks),
    antibody(Antibody),
    affinity(Antigen, Antibody, Psi),
    affinity_threshold(Threshold),
    Psi >= Threshold.

%   A memory cell reports no wins, so that it is not appointed again.

offer(Attack, offer(Attack, Antibody, Gamma, Memory, Wins)) :-
    antibody(Antibody),
    gamma(Gamma),
    memory(Memory),
    (   expiry(never)
    ->  Wins = 0
    ;   wins(Wins)
    ).

heed(redundant, Attack) :-
    shun(Attack).
heed(over, Attack) :-
    shun(Attack).
heed(outcome(Gamma, Memory, Wins, Cell), Attack) :-
    shun(Attack),
    keep(memory(Memory)),
    keep(wins(Wins)),
    appointed(Cell),
    parameter(gamma_min, Minimum),
    parameter(gamma_max, Maximum),
    fate(Gamma, Minimum, Maximum, Fate),
    meet(Fate, Gamma).

appointed(true) :-
    !,
    antibody(Antibody),
    keep(expiry(never)),
    log(memory_cell(Antibody)).
appointed(false).

%   The last attacks are enough: signals of earlier ones have evaporated.

shun(Attack) :-
    shunned(Attacks0),
    (   length(Recent, 11),
        append(Recent, _, Attacks0)
    ->  true
    ;   Recent = Attacks0
    ),
    keep(shunned([Attack|Recent])).

                /*******************************
                *             FATE             *
                *******************************/

meet(stay, Gamma) :-
    keep(gamma(Gamma)).
meet(die, _) :-
    expiry(never),
    !,
    parameter(gamma, Start),
    keep(gamma(Start)).
meet(die, _) :-
    die(suppressed).
meet(clone, _) :-
    parameter(gamma, Start),
    keep(gamma(Start)),
    multiply.

%   In a crowd an agent does not clone: this limits the number of clones.

multiply :-
    host_load(Load),
    parameter(crowd, Crowd),
    Load < Crowd,
    !,
    clone_if_room(Branch),
    multiplied(Branch).
multiply.

multiplied(refused).
multiplied(parent(_)).
multiplied(clone(_)) :-
    hops(Hops),
    parameter(omega, Omega),
    Expiry is Hops + Omega,
    keep(expiry(Expiry)),
    keep(wins(0)),
    forget_visits,
    antibody(Antibody),
    log(born(clone, Antibody)).

die(Cause) :-
    antibody(Antibody),
    log(died(Cause, Antibody)),
    dispose.

age :-
    expiry(Expiry),
    integer(Expiry),
    hops(Hops),
    Hops >= Expiry,
    !,
    die(aged).
age.

                /*******************************
                *            PATROL            *
                *******************************/

travel :-
    destination(Host),
    !,
    catch(move(Host), error(_, _), sleep(1)).
travel :-
    sleep(1).                           % an isolated host

destination(Host) :-
    findall(Strength-Attack,
            ( pheromone(Attack, _, Strength), wanted(Attack) ),
            Scents),
    strongest(Scents, Attack),
    !,
    next_host(phercon(Attack), Host).
destination(Host) :-
    next_host(conscientious, Host).

strongest(Scents, Attack) :-
    pairs_keys(Scents, Strengths),
    max_list(Strengths, Most),
    findall(Attack, member(Most-Attack, Scents), Attacks),
    random_member(Attack, Attacks).
