:- module(test_authors, []).

% Hosts that admit only programs signed by certain authors.

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/peers').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(typhon)).
:- use_module('../../../../app/typhon/keys', [keys_revoke/2, keys_sign_file/3]).

:- needs([openssl]).

%   The program in a file of its own, so that no process has it yet.

program(Authority, Name, File) :-
    atom_concat(Name, '.pl', Base),
    directory_file_path(Authority, Base, File),
    write_file(File, ':- agent(~w, [state([to/1])]).~n\c
                      main :- to(Host), move(Host), here(H), ~w(H).~n\c
                      ~w(_).~n', [Name, Name, Name]).

%   with_choosy_host(+Hosts, +Authors, -Authority, -Alpha, :Goal): alpha, which
%   wants signatures of alice, and open are here; beta is a process.

:- meta_predicate with_choosy_host(+, +, -, -, 0).

with_choosy_host(Hosts, Authors, Authority, Alpha, Goal) :-
    with_authority(Hosts, Authors, Authority,
        ( keys_of(alpha, Authority, Dir),
          keys_of(beta, Authority, Beta),
          findall(beta-[host([tls(Beta)])], member(beta, Hosts), Peers),
          with_peers(Peers,
              setup_call_cleanup(
                  ( host_start(alpha, [tls(Dir), authors([alice])]),
                    host_start(open, []) ),
                  ( host_property(alpha, address(Alpha)), once(Goal) ),
                  ( host_stop(open), host_stop(alpha) ))) )).

is_refused(Outcome) :-
    subsumes_term(refused(move_refused(_, unsigned)), Outcome).

signed(Authority, Name, Author, File) :-
    program(Authority, Name, File),
    keys_sign_file(File, Author, Authority).

created(File, Host, Outcome) :-
    host_property(alpha, address(Alpha)),
    catch(( agent_create(File, Agent, [host(Host), facts([to(Alpha)])]),
            agent_join(Agent, Outcome, 10) ),
          error(Formal, _),
          Outcome = refused(Formal)).

:- begin_tests(authors, [setup(true)]).

test(only_programs_signed_by_alice_are_admitted) :-
    with_choosy_host([alpha, beta], [alice, bob], Authority, Alpha,
                     authors_of(Authority, Alpha)).

authors_of(Authority, Alpha) :-
    signed(Authority, alices, alice, Alices),
    signed(Authority, bobs, bob, Bobs),
    program(Authority, nobodys, Nobodys),
    Refused = raised(error(move_refused(Alpha, unsigned), _)),
    peer_host(beta, Beta),
    forall(member(File-Expected,
                  [Alices-done, Bobs-Refused, Nobodys-Refused]),
           ( created(File, alpha, Here),
             forall(member(Host, [open, Beta]),
                    ( created(File, Host, There),
                      assertion(subsumes_term(Expected, There)) )),
             peer_do(beta, catch(( agent_create(File, A, [host(Alpha),
                                                 facts([to(Alpha)])]),
                                   agent_join(A, Far, 10) ),
                                 error(F, _), Far = refused(F))),
             forall(member(Outcome, [Here, Far]),
                    assertion(( Expected == done -> Outcome == done
                              ; is_refused(Outcome) ))) )).

test(changed_program_is_not_signed, Before == done) :-
    with_choosy_host([alpha], [alice], Authority, _,
        ( signed(Authority, mine, alice, File),
          created(File, alpha, Before),
          setup_call_cleanup(open(File, append, Out),
                             format(Out, 'evil.~n', []),
                             close(Out)),
          created(File, alpha, After) )),
    assertion(is_refused(After)).

%   The libraries of a program that no admitted author has signed are not
%   loaded, and no order gives it to an agent.

test(unsigned_programs_load_nothing) :-
    with_choosy_host([alpha, beta], [alice], Authority, Alpha,
                     unsigned_program(Authority, Alpha)).

unsigned_program(Authority, Alpha) :-
    Terms = [ (:- agent(x, [])), (:- use_module(library(www_browser))),
              on_message(_, _) ],
    outcome(agent_create(clauses(Terms), _, [host(alpha)]), Here),
    assertion(subsumes_term(move_refused(_, unsigned), Here)),
    peer_do(beta, catch(( agent_create(clauses(Terms), _, [host(Alpha)]),
                          There = created ), error(There, _), true)),
    assertion(subsumes_term(move_refused(_, unsigned), There)),
    signed_resident(Authority, rests, File0),
    signed_resident(Authority, waits, File),
    agent_create(File0, Agent, [host(alpha)]),
    outcome(agent_change(Agent, program(clauses(Terms))), Change),
    assertion(Change == permission_error(change, agent_program, Agent)),
    outcome(agent_change(Agent, program(File)), Signed),
    assertion(Signed == true),
    agent_dispose(Agent),
    assertion(\+ ( source_file(Source),
                   file_base_name(Source, 'www_browser.pl') )).

outcome(Goal, Outcome) :-
    catch(( call(Goal), Outcome = true ), error(Outcome, _), true).

signed_resident(Authority, Name, File) :-
    resident(Authority, Name, File),
    keys_sign_file(File, alice, Authority).

resident(Authority, Name, File) :-
    atom_concat(Name, '.pl', Base),
    directory_file_path(Authority, Base, File),
    write_file(File, ':- agent(~w, []).~non_message(_, ~w).~n', [Name, Name]).

%   This process reads the signature that another has written.

test(signature_beside_the_file_is_read, Outcome == true) :-
    with_choosy_host([alpha, beta], [alice], Authority, _,
        ( resident(Authority, read, File),
          beta_signs(File, Authority),
          outcome(agent_create(File, _, [host(alpha)]), Outcome) )).

test(signature_that_comes_after_the_file_was_read_is_read,
     Outcomes == [false,true]) :-
    with_choosy_host([alpha, beta], [alice], Authority, _,
        ( resident(Authority, later, File),
          get_time(Now),
          Before is Now-60,
          set_time_file(File, _, [modified(Before)]),
          findall(Outcome,
                  ( member(Goal, [true, beta_signs(File, Authority)]),
                    call(Goal),
                    ( catch(agent_create(File, _, [host(alpha)]),
                            error(move_refused(_, _), _), fail)
                    -> Outcome = true
                    ;  Outcome = false
                    ) ),
                  Outcomes) )).

beta_signs(File, Authority) :-
    project_file('app/typhon/keys', Keys),
    peer_do(beta, ( use_module(Keys, []),
                    typhon_app_keys:keys_sign_file(File, alice, Authority) )).

%   The owner of an agent is the author, not the process that has sent it.

test(quotas_of_owners_are_those_of_authors,
     Outcomes == [true,true,move_refused(Alpha, quota(agents))]) :-
    with_choosy_host([alpha, beta], [alice, bob], Authority, Alpha,
        ( host_change(alpha, authors([alice,bob])),
          host_change(alpha, quota([owner(agents(1))])),
          findall(Outcome,
                  ( member(Name-Author, [one-alice,two-bob,three-alice]),
                    resident(Authority, Name, File),
                    keys_sign_file(File, Author, Authority),
                    peer_do(beta, catch(( agent_create(File, _, [host(Alpha)]),
                                          Outcome = true ),
                                        error(Outcome, _), true)) ),
                  Outcomes) )).

test(hosts_and_revoked_authors_cannot_sign, Before == done) :-
    with_choosy_host([alpha], [alice], Authority, _,
        ( host_change(alpha, authors([alice, alpha])),
          signed(Authority, one, alpha, One),
          created(One, alpha, ByHost),
          signed(Authority, two, alice, Two),
          created(Two, alpha, Before),
          keys_revoke(alice, Authority),
          created(Two, alpha, After) )),
    assertion(is_refused(ByHost)),
    assertion(is_refused(After)).
test(only_payloads_signed_by_alice_are_admitted) :-
    with_choosy_host([alpha, beta], [alice], Authority, Alpha,
                     payloads_of(Authority, Alpha)).
test(authors_need_keys, error(existence_error(host_option, tls))) :-
    host_start(alpha, [authors([alice])]).

:- end_tests(authors).

                 /*******************************
                 *            PAYLOADS          *
                 *******************************/

payload(Authority, Name, File) :-
    atom_concat(Name, '.pl', Base),
    directory_file_path(Authority, Base, File),
    write_file(File, ':- payload(~w, [provides([~w/1, rule/1])]).~n\c
                      ~w(1).~nrule(X) :- X, findall(Y, X, _), \\+ Y.~n\c
                      rule(X) :- call(X, 1), ~w(X).~n',
                     [Name, Name, Name, Name]).

%   The program is signed; its payload may be.

carrier(Authority, File) :-
    directory_file_path(Authority, 'carrier.pl', File),
    write_file(File, ':- agent(carrier, [state([to/1])]).~n\c
                      on_message(_, go(Host)) :- move(Host).~n\c
                      on_message(_, do(Goal)) :- call(Goal).~n\c
                      on_message(_, try(Goal)) :-~n  \c
                        catch(Goal, error(Formal, _), true), result(Formal).~n',
                     []),
    keys_sign_file(File, alice, Authority).

payloads_of(Authority, Alpha) :-
    carrier(Authority, Carrier),
    payload(Authority, good, Good),
    payload(Authority, bad, Bad),
    keys_sign_file(Good, alice, Authority),
    keys_sign_file(Bad, beta, Authority),
    peer_host(beta, Beta),
    forall(member(Host, [open, Beta]),
           ( carries(Carrier, Good, Host, Alpha, true, Came),
             assertion(Came == arrived),
             carries(Carrier, Bad, Host, Alpha, true, Not),
             assertion(Not == refused(move_refused(Alpha, unsigned))),
             carries(Carrier, Good, Host, Alpha, assertz(good(2)), Changed),
             assertion(Changed == refused(move_refused(Alpha, unsigned))) )),
    guards_on_the_way(Carrier, Good, Beta, Alpha),
    attached_from_afar(Carrier, Authority),
    begins_with(Carrier, Good, arrived),
    begins_with(Carrier, Bad, refused(move_refused(Alpha, unsigned))),
    on_the_spot(Carrier, Good, Bad, Alpha).

%   The outcome of a carrier that moves to Alpha after a goal.

carries(Carrier, Payload, Host, Alpha, Do, Came) :-
    agent_create(Carrier, Agent, [host(Host), payloads([Payload])]),
    agent_send(Agent, do(Do)),
    agent_send(Agent, go(Alpha)),
    wait_until(carried(Agent, Alpha, Came), 20).

carried(Agent, Alpha, arrived) :-
    agent_property(Agent, host(Alpha)),
    agent_property(Agent, state(resident)).
carried(Agent, _, refused(Formal)) :-
    agent_property(Agent, state(faulty(error(Formal, _)))).

%   Data that a guarding host writes into the program do not count.

guards_on_the_way(Carrier, Good, Beta, Alpha) :-
    host_start(guarding, [policy(guarded), cell(none)]),
    host_property(guarding, address(Guarding)),
    carries(Carrier, Good, Beta, Guarding, true, First),
    assertion(First == arrived),
    agent_property(Agent, host(Guarding)),
    agent_property(Agent, facts(Facts)),
    assertion(( sub_term(Sub, Facts), subsumes_term('$checked'(_), Sub) )),
    agent_send(Agent, go(Alpha)),
    wait_until(carried(Agent, Alpha, Came), 20),
    assertion(Came == arrived),
    host_stop(guarding).

%   This process neither signs nor reads the payload: its signature comes with
%   the order.

attached_from_afar(Carrier, Authority) :-
    payload(Authority, far, Far),
    agent_create(Carrier, Agent, [host(alpha)]),
    project_file('app/typhon/keys.pl', Keys),
    peer_do(beta, ( use_module(Keys, [keys_sign_file/3]),
                    keys_sign_file(Far, alice, Authority),
                    payload_attach(Agent, Far) )).

begins_with(Carrier, Payload, Expected) :-
    catch(( agent_create(Carrier, _, [host(alpha), payloads([Payload])]),
            Came = arrived ),
          error(Formal, _),
          Came = refused(Formal)),
    assertion(Came = Expected).

%   On alpha itself no other payload can be attached, from within or from
%   outside, and no changed one delivered.

on_the_spot(Carrier, Good, Bad, Alpha) :-
    Refused = error(move_refused(Alpha, unsigned), _),
    agent_create(Carrier, Agent, [host(alpha)]),
    catch(payload_attach(Agent, Bad), Error, true),
    assertion(subsumes_term(Refused, Error)),
    payload_attach(Agent, Good),
    agent_send(Agent, do(deliver(good))),
    wait_until(remote(alpha, catch(good(1), error(_, _), fail)), 10),
    agent_send(Agent, do(undeliver(good))),
    agent_send(Agent, do(assertz(good(2)))),
    agent_send(Agent, do(deliver(good))),
    wait_until(agent_property(Agent, state(faulty(Fault))), 10),
    assertion(subsumes_term(Refused, Fault)),
    agent_create(Carrier, Other, [host(alpha)]),
    agent_send(Other, do(attach(Bad))),
    wait_until(agent_property(Other, state(faulty(Again))), 10),
    assertion(subsumes_term(Refused, Again)).
