:- module(test_owners, []).

% Processes that take the id of another's agent, or send messages in its name:
% mallory has a certificate, and had one of the agents as a guest.

:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- needs([openssl]).

%   The owners are alpha, which is here, and mallory; beta has a host.

:- meta_predicate with_owners(0).

with_owners(Goal) :-
    with_authority([alpha, beta, mallory], [], Authority,
        ( maplist({Authority}/[Name,Dir]>>keys_of(Name, Authority, Dir),
                  [alpha, beta, mallory], [Alpha, Beta, Mallory]),
          with_peers([ beta-[host([tls(Beta), cell(none)])],
                       mallory-[host([tls(Mallory)])] ],
                     setup_call_cleanup(host_start(alpha, [tls(Alpha)]),
                                        once(Goal),
                                        host_stop(alpha))) )).

%   A guest moves and sends messages on order, and stores received messages.

guest(clauses([ (:- agent(guest, [state([received/2])])),
                (on_message(_, go(Host)) :- move(Host)),
                (on_message(_, say(To, What)) :- send(To, What)),
                (on_message(From, received(What)) :-
                     assertz(received(From, What))) ])).

resides(Agent, Peer) :-
    peer_host(Peer, Host),
    agent_send(Agent, go(Host)),
    is_at(Agent, Host).

is_at(Agent, Host) :-
    wait_until(( agent_property(Agent, host(Host)),
                 agent_property(Agent, state(resident)) ), 20).

received(Agent, Heard) :-
    agent_property(Agent, facts(Facts)),
    findall(From-What, member(received(From, What), Facts), Heard).

endpoint(Peer, Endpoint) :-
    peer_host(Peer, Host),
    typhon_hosts:address_parts(Host, _, Endpoint).

%   Mallory makes the image of an agent of its own, and its birth certificate.

mallory_image(Image, Birth) :-
    guest(Program),
    peer_do(mallory,
            ( agent_create(Program, A),
              typhon_image:image_hop(A, _, [], [], 0, Image),
              typhon_image:image_hash(Image, Hash) )),
    birth_signed(mallory, A, Hash, Birth).

%   The answer of beta to an image from mallory.

brought(Image, Birth, Answer) :-
    endpoint(beta, Beta),
    guest(Program),
    peer_do(mallory,
            ( typhon_reading:program_load(Program, _, _, Hash, _, _),
              typhon_code:code_sent(Hash, Sent0),
              ( Birth == none -> Sent = Sent0 ; Sent = papers(Birth, Sent0) ),
              typhon_wire:endpoint_call(Beta, hop, hop(beta, Image, Sent),
                                        Answer, 10) )).

:- begin_tests(owners).

test(honest_agents_are_admitted_and_forged_ones_refused) :-
    with_owners(( honest, boxes, ids_taken, senders_forged, news_forged,
                  program_changed, guarded )).

:- end_tests(owners).

%   From alpha by way of mallory to beta and back; the messages sent on the way
%   arrive.

honest :-
    guest(Program),
    agent_create(Program, A),
    assertion(sub_atom(A, _, _, _, '-alpha.')),
    peer_host(beta, Beta),
    agent_create(Program, B, [host(Beta)]),
    assertion(sub_atom(B, _, _, _, '-beta.')),
    resides(A, mallory),
    agent_send(A, say(B, received(from_mallory))),
    resides(A, beta),
    agent_send(A, say(B, received(from_beta))),
    births_saved(beta),
    host_property(alpha, address(Alpha)),
    agent_send(A, go(Alpha)),
    is_at(A, Alpha),
    agent_send(A, say(B, received(from_home))),
    wait_until(( received(B, Heard), length(Heard, 3) ), 20),
    assertion(Heard == [ A-from_mallory, A-from_beta, A-from_home ]),
    agent_send(B, say(A, received(back))),
    wait_until(received(A, [B-back]), 20).

%   A box at mallory, which takes no messages of alpha's agent from beta: those
%   go by way of alpha.

boxes :-
    guest(Program),
    agent_create(Program, A),
    peer_host(mallory, Host),
    peer_do(mallory,
            ( use_module(library(typhon/options/external_recipients), []),
              dynamic([ user:boxed/3, typhon_external_recipients:carried/4 ]),
              assertz(( typhon_external_recipients:carried(_, box(N), F, M) :-
                            assertz(user:boxed(N, F, M)) )) )),
    agent_send(A, say(at(box(1), Host), from_home)),
    wait_until(peer_do(mallory, user:boxed(1, A, from_home)), 20),
    resides(A, beta),
    agent_send(A, say(at(box(2), Host), from_beta)),
    wait_until(peer_do(mallory, user:boxed(2, A, from_beta)), 20).

%   An agent there could not continue from a network that was saved and loaded.
%   As a network does, the test waits until no agent runs there: A has just
%   received a message.

births_saved(Peer) :-
    peer_do(Peer,
            ( use_module(library(typhon/network/node_process), []),
              forall(member(Order, [hold(5), rest(20, [])]),
                     typhon_node_process:order_do(Order, ok)),
              typhon_node_process:order_do(kept([Peer]), kept(_, _, Items)),
              findall(item(birth, Id, N, Birth),
                      member(item(birth, Id, N, Birth), Items), Births),
              forall(typhon_identity:ids_anew, true),
              typhon_node_process:order_do(fill(real, Births), ok),
              typhon_node_process:order_do(let_go, ok) )).

%   Mallory has A's birth certificate, since A was its guest; of C it knows the
%   id only, but beta knows C.

ids_taken :-
    guest(Program),
    agent_create(Program, A),
    agent_create(Program, C),
    resides(A, mallory),
    resides(C, beta),
    host_property(alpha, address(Alpha)),
    forall(member(Agent, [A, C]),
           ( agent_send(Agent, go(Alpha)), is_at(Agent, Alpha) )),
    mallory_image(image(Own, Hash, life(P, _, L, T, Ps, S, Ts), State, Goals,
                        Mail, Since), HerBirth),
    Life = life(P, 9, L, T, Ps, S, Ts),
    peer_do(mallory, typhon_birth:birth_shown(A, BirthOfA)),
    assertion(BirthOfA = birth(A, Hash, _, _)),
    forall(forged(Case, C, A, Hash, BirthOfA, HerBirth, Id, ItsHash, Birth),
           ( brought(image(Id, ItsHash, Life, State, Goals, Mail, Since),
                     Birth, Answer),
             assertion(memberchk(Case-Answer,
                                 [ _-answer(refused(identity)),
                                   without-answer(need_program) ])) )),
    brought(image(Own, Hash, Life, State, Goals, Mail, Since), HerBirth,
            Honest),
    assertion(Honest == answer(accepted)),
    long_id(Own, Long),
    birth_signed(mallory, Long, Hash, LongBirth),
    brought(image(Long, Hash, Life, State, Goals, Mail, Since), LongBirth,
            TooLong),
    assertion(TooLong == answer(refused(identity))).

%   The id would be mallory's own, and beta would have to remember it.

long_id(Own, Long) :-
    format(atom(Long), '~`xt~20000|~w', [Own]).

%   forged(-Case, +C, +A, +Hash, +BirthOfA, +HerBirth, -Id, -ItsHash, -Birth)

forged(without, C, _, Hash, _, _, C, Hash, none).
forged(with_her_own, C, _, Hash, _, Hers, C, Hash, Hers).
forged(with_her_own_renamed, C, _, Hash, _, birth(_, _, Pem, Hex), C, Hash,
       birth(C, Hash, Pem, Hex)).
forged(signed_by_her, C, _, Hash, _, _, C, Hash, Birth) :-
    birth_signed(mallory, C, Hash, Birth).
forged(another_program, _, A, _, birth(A, _, Pem, Hex), _, A, another,
       birth(A, another, Pem, Hex)).
forged(that_of_another, C, _, Hash, Birth, _, C, Hash, Birth).
forged(that_of_another_renamed, C, _, Hash, birth(_, _, Pem, Hex), _, C, Hash,
       birth(C, Hash, Pem, Hex)).
forged(no_text, C, _, Hash, _, _, C, Hash, birth(C, Hash, _, f(x))).
forged(no_birth, C, _, Hash, _, _, C, Hash, [_|_]).

senders_forged :-
    guest(Program),
    peer_host(beta, BetaHost),
    endpoint(beta, Beta),
    agent_create(Program, A),
    agent_create(Program, B, [host(BetaHost)]),
    peer_do(mallory, agent_create(Program, M)),
    birth_signed(mallory, M, hash, Birth),
    many_shown(300, A, B, Birth, Many),
    forall(member(Term,
                  [ message(B, [mail(x, A, received(forged))], 5),
                    shown([], message(B, [mail(x, A, received(forged))], 5)),
                    shown([Birth, _, f(x)],
                          message(B, [mail(x, A, received(forged))], 5)),
                    message(B, [mail(x, _, received(forged))], 5),
                    message(B, [mail(x, B, received(forged))], 5),
                    Many ]),
           peer_do(mallory,
                   typhon_wire:endpoint_post(Beta, message, Term))),
    peer_do(mallory, agent_send(M, say(B, received(honest)))),
    wait_until(received(B, [_|_]), 20),
    agent_send(A, say(B, received(from_a))),
    wait_until(( received(B, Heard), length(Heard, 2) ), 20),
    assertion(Heard == [M-honest, A-from_a]).

%   Checking each of them for each message would take minutes.

many_shown(Count, A, B, birth(_, Hash, Pem, Hex),
           shown(Births, message(B, Mail, 5))) :-
    numlist(1, Count, Ns),
    findall(birth(A, Other, Pem, Hex),
            ( member(N, Ns), atom_concat(Hash, N, Other) ), Births),
    findall(mail(x, A, received(N)), member(N, Ns), Mail).

news_forged :-
    guest(Program),
    agent_create(Program, A),
    host_property(alpha, address(Alpha)),
    typhon_hosts:address_parts(Alpha, _, Endpoint),
    peer_host(mallory, Mallory),
    peer_do(mallory,
            ( typhon_wire:endpoint_post(Endpoint, whereabouts,
                  [ located(A, Mallory, 5), ended(A, done, 9),
                    faulty(A, failed, 1.0, Mallory, 9) ]),
              agent_create(Program, M),
              agent_send(M, say(A, received(done))) )),
    wait_until(received(A, [M-done]), 20),
    agent_join(A, Outcome, 0),
    assertion(Outcome == timeout),
    agent_send(A, received(still_here)),
    wait_until(received(A, [M-done, user-still_here]), 10).

%   On another host than its home no host would admit it.

program_changed :-
    guest(Program),
    agent_create(Program, A),
    Other = clauses([ (:- agent(guest, [state([received/2])])),
                      (on_message(_, go(Host)) :- move(Host)),
                      (on_message(_, other) :- true) ]),
    agent_change(A, program(Other)),
    resides(A, mallory),
    peer_host(mallory, Mallory),
    catch(agent_change(A, program(Program)), error(Formal, _), true),
    assertion(Formal == permission_error(change, agent_program, A)),
    assertion(agent_property(A, host(Mallory))).

guarded :-
    guest(Program),
    peer_do(beta, host_change(beta, policy(guarded))),
    agent_create(Program, A),
    resides(A, mallory),
    resides(A, beta),
    agent_trail(A, Trail),
    assertion(Trail = trail([_, _, _, _], whole)).
