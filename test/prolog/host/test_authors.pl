:- module(test_authors, []).

% Hosts that let in only programs that certain authors have signed.

:- use_module('../../lib/common').
:- use_module('../../lib/authority').
:- use_module('../../lib/peers').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module('../../../app/keys', [keys_revoke/2, keys_sign_file/3]).

:- needs([openssl]).

own(Authority, Name, Dir) :-
    directory_file_path(Authority, Name, Dir).

%   The program in a file of its own, so that nobody has it yet.

program(Authority, Name, File) :-
    atom_concat(Name, '.pl', Base),
    directory_file_path(Authority, Base, File),
    setup_call_cleanup(
        open(File, write, Out),
        format(Out, ':- agent(~w, [state([to/1])]).~n\c
                     main :- to(Host), move(Host), here(H), ~w(H).~n\c
                     ~w(_).~n', [Name, Name, Name]),
        close(Out)).

:- meta_predicate with_choosy_host(+, 1).

with_choosy_host(Authority, Goal) :-
    own(Authority, alpha, Dir),
    setup_call_cleanup(
        ( host_start(alpha, [tls(Dir), authors([alice])]),
          host_start(open, []) ),
        ( host_property(alpha, address(Address)),
          once(call(Goal, Address)) ),
        ( host_stop(open), host_stop(alpha) )).

created(File, Host, Outcome) :-
    host_property(alpha, address(Alpha)),
    catch(( agent_create(File, Agent, [host(Host), facts([to(Alpha)])]),
            agent_join(Agent, Outcome, 10) ),
          error(Formal, _),
          Outcome = refused(Formal)).

:- begin_tests(authors, [setup(true)]).

test(only_what_alice_has_signed_begins_or_comes) :-
    with_authority([alpha, beta], [alice, bob], authors_of).

authors_of(Authority) :-
    own(Authority, beta, Dir),
    with_peers([beta-[host([tls(Dir)])]],
               with_choosy_host(Authority, authors_of(Authority))).

authors_of(Authority, Alpha) :-
    forall(member(Name, [alices, bobs, nobodys]),
           program(Authority, Name, _)),
    own(Authority, 'alices.pl', Alices),
    own(Authority, 'bobs.pl', Bobs),
    own(Authority, 'nobodys.pl', Nobodys),
    keys_sign_file(Alices, alice, Authority),
    keys_sign_file(Bobs, bob, Authority),
    Refused = raised(error(move_refused(Alpha, unsigned), _)),
    peer_host(beta, Beta),
    forall(member(File-Expected,
                  [Alices-done, Bobs-Refused, Nobodys-Refused]),
           ( created(File, alpha, Here),
             assertion(( Expected == done -> Here == done
                       ; subsumes_term(refused(move_refused(_, unsigned)),
                                       Here) )),
             forall(member(Host, [open, Beta]),
                    ( created(File, Host, There),
                      assertion(subsumes_term(Expected, There)) )),
             peer_do(beta, catch(( agent_create(File, A, [host(Alpha),
                                                 facts([to(Alpha)])]),
                                   agent_join(A, Far, 10) ),
                                 error(F, _), Far = refused(F))),
             assertion(( Expected == done -> Far == done
                       ; subsumes_term(refused(move_refused(_, unsigned)),
                                       Far) )) )).

test(a_changed_program_is_not_signed) :-
    with_authority([alpha], [alice], changed_program).

changed_program(Authority) :-
    with_choosy_host(Authority, changed_program(Authority)).

changed_program(Authority, _) :-
    program(Authority, mine, File),
    keys_sign_file(File, alice, Authority),
    created(File, alpha, Before),
    setup_call_cleanup(open(File, append, Out),
                       format(Out, 'evil.~n', []),
                       close(Out)),
    created(File, alpha, After),
    assertion(Before == done),
    assertion(subsumes_term(refused(move_refused(_, unsigned)), After)).

test(a_host_is_no_author_and_who_is_revoked_neither) :-
    with_authority([alpha], [alice], no_author).

no_author(Authority) :-
    with_choosy_host(Authority, no_author(Authority)).

no_author(Authority, _) :-
    program(Authority, one, One),
    host_change(alpha, authors([alice, alpha])),
    keys_sign_file(One, alpha, Authority),
    created(One, alpha, ByHost),
    assertion(subsumes_term(refused(move_refused(_, unsigned)), ByHost)),
    program(Authority, two, Two),
    keys_sign_file(Two, alice, Authority),
    created(Two, alpha, Before),
    assertion(Before == done),
    keys_revoke(alice, Authority),
    created(Two, alpha, After),
    assertion(subsumes_term(refused(move_refused(_, unsigned)), After)).

test(authors_need_keys, error(existence_error(host_option, tls))) :-
    host_start(alpha, [authors([alice])]).

:- end_tests(authors).
