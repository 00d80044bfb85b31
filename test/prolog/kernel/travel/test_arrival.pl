:- module(test_arrival, []).
:- use_module('../../../lib/common').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire),
              [endpoint_address/1, endpoint_call/5]).
:- use_module(library(typhon/kernel/program), [program_hash/2]).
:- use_module('../../../lib/fixtures').

/** <module> An agent arrives whole or not at all

Images that a faulty peer could send, sent by hand. The valid agent that
arrives later under the same id is admitted.
*/

:- begin_tests(arrival).

test(invalid_image_is_refused,
     [forall(bad(Image, Id, Why)), true(Answer == refused(error(Why)))]) :-
    with_hosts([alpha],
               quietly(( image([], Good0),
                         arg(1, Good0, Id),
                         bad_image(Image, Good0, Bad),
                         sent(Bad, Answer),
                         alone,
                         sent(Good0, accepted),
                         arrived(Good0) ))).
test(program_with_another_hash,
     true(Answer = refused(error(domain_error(program_of_hash(_), _))))) :-
    with_hosts([alpha],
               quietly(( image([], Image),
                         program(_, Program0),
                         Program0 = program(N, S, L, _),
                         Program = program(N, S, L, [(main:-halt)]),
                         sent(Image, Program, Answer),
                         alone,
                         sent(Image, accepted),
                         arrived(Image) ))).
test(image_arrives_twice, true(Answer == accepted)) :-
    with_hosts([alpha-[capacity(1)]],   % full when it comes again
               ( image([], Image),
                 sent(Image, accepted),
                 arrived(Image),
                 sent(Image, Answer) )).
test(hop_that_came_before_is_recognised, true(Loads == [1,1,0])) :-
    with_hosts([alpha],
               ( image([], First),
                 sent(First, accepted),  % with the program
                 arrived(First),
                 arg(1, First, A),
                 disposed(A),
                 image([], Image),
                 arg(1, Image, B),
                 findall(Load,
                         ( member(Goal, [true, true, disposed(B)]),
                           call(Goal),
                           handed(Image),
                           host_property(alpha, load(Load)) ),
                         Loads) )).
test(agent_that_ends_before_it_is_asked_for_has_ended, Load == 0) :-
    with_hosts([alpha],
               ( image([], Image0),
                 setarg(5, Image0, [numlist(1, 1 000 000, _)]),
                 sent(Image0, accepted),
                 arg(1, Image0, Id),
                 setup_call_cleanup(
                     wrap_predicate(typhon_questions:agent_urge(_, _, _, _), late,
                                    Wrapped,
                                    ( test_arrival:empty, Wrapped )),
                     agent_dispose(Id),
                     unwrap_predicate(typhon_questions:agent_urge/4, late)),
                 host_property(alpha, load(Load)) )).
test(hop_before_the_last_known_one_is_recognised_at_home, Load == 0) :-
    with_hosts([alpha],
               ( image([], First),
                 sent(First, accepted),
                 arrived(First),
                 arg(1, First, A),
                 disposed(A),
                 address(alpha, Home),
                 atom_concat('x.1.home@', Home, Id),
                 typhon_whereabouts:agent_born(Id, Home),
                 typhon_whereabouts:agent_departed_to(Id,
                                                      'far@127.0.0.1:1', 3,
                                                      '127.0.0.1:1'),
                 image([], Image0),
                 bad_image(id(Id), Image0, Image),
                 handed(Image),
                 host_property(alpha, load(Load)),
                 typhon_whereabouts:agent_ended(Id, disposed, 3, []) )).
test(hop_of_a_number_that_came_before_has_no_effect,
     [First, Second] == [accepted, accepted]) :-
    with_hosts([alpha],
               ( image([], Image),
                 image([], Other),
                 sent_as(Image, hop_id(p, 7, 7), First),
                 arrived(Image),
                 sent_as(Other, hop_id(p, 7, 7), Second),
                 host_property(alpha, load(1)),
                 sent_as(Other, hop_id(p, 8, 7), accepted),
                 wait_until(host_property(alpha, load(2)), 5) )).
test(earlier_hop_of_an_agent_that_has_ended_has_no_effect,
     Answer == accepted) :-
    with_hosts([alpha],
               ( agent_create(clauses([(:- agent(x, [])), main]), Id),
                 joined(Id, done),
                 image([], Image0),
                 bad_image(id(Id), Image0, Image),
                 sent(Image, Answer),
                 alone )).
test(invalid_image_leaves_nothing) :-
    with_hosts([alpha],
               ( image([], Good),
                 sent(Good, accepted),
                 arrived(Good),
                 no_leaks(quietly(
                     ( image([], Other),
                       bad_image(state([], [fine, (1:-true)]), Other, Bad),
                       sent(Bad, _) ))) )).

:- end_tests(arrival).

%   bad(?Change, ?Id, ?Error): Error is the answer to the image of Id with that
%   Change.

bad(mail(none), Id, type_error(agent_image, Id)).
bad(mail([hello]), Id, type_error(agent_image, Id)).
bad(goals(main), Id, type_error(agent_image, Id)).
bad(since(long_ago), Id, type_error(agent_image, Id)).
bad(life(young), Id, type_error(agent_image, Id)).
bad(id(unknown), _, type_error(agent_image, unknown)).
bad(id(Id), _, type_error(agent_image, Id)) :-
    member(Char, ['\e', '\n', '\000\', '\u202e']),
    atomic_list_concat([a, Char, '.x.0@far@127.0.0.1:1'], Id).
bad(state(none), Id, type_error(agent_image, Id)).
bad(state([], [1]), _, type_error(callable, 1)).
bad(state([], [(foo:-1)]), _, Error) :-
    catch(assertz((foo:-1)), error(Error, _), true).

bad_image(id(X), image(_, H, L, S, G, M, T), image(X, H, L, S, G, M, T)).
bad_image(life(X), image(I, H, _, S, G, M, T), image(I, H, X, S, G, M, T)).
bad_image(state(X), image(I, H, L, _, G, M, T), image(I, H, L, X, G, M, T)).
bad_image(state(X, Y), image(I, H, L, _, G, M, T),
          image(I, H, L, state(X, Y), G, M, T)).
bad_image(goals(X), image(I, H, L, S, _, M, T), image(I, H, L, S, X, M, T)).
bad_image(mail(X), image(I, H, L, S, G, _, T), image(I, H, L, S, G, X, T)).
bad_image(since(X), image(I, H, L, S, G, M, _), image(I, H, L, S, G, M, X)).

program(Hash, Program) :-
    Program = program(x, [], [], [(main:-true), (on_message(_,_):-true)]),
    program_hash(Program, Hash).

%   No agent arrives under the id of one that has ended.

image(Mail, image(Id, Hash,
                  life(none, 3, inf, [], [], false, []),
                  state([], [fact(1)]), [], Mail, Now)) :-
    flag(test_arrival, N, N+1),
    format(atom(Id), 'x.1.~d@far@127.0.0.1:1', [N]),
    program(Hash, _),
    get_time(Now).

sent(Image, Answer) :-
    program(_, Program),
    sent(Image, Program, Answer).

sent(Image, Program, Answer) :-
    asked(hop(alpha, Image, Program), Answer).

asked(Hop, Answer) :-
    endpoint_address(Endpoint),
    endpoint_call(Endpoint, hop, Hop, answer(Answer), 10).

%   By a frame that hands the agent over.

handed(image(Id, Hash, Life, State, Goals, Mail, Since)) :-
    once(typhon_endpoint:handed(hop,
                                hop(alpha,
                                    image(Id, Hash, Life, State, _-Goals, Mail,
                                          Since),
                                    known),
                                '127.0.0.1:1', accepted)).

sent_as(Image, HopId, Answer) :-
    program(_, Program),
    asked(hop(alpha, Image, Program, HopId), Answer).

arrived(Image) :-
    arg(1, Image, Id),
    wait_until(agent_property(Id, state(resident)), 5),
    agent_property(Id, facts([fact(1)])),
    host_property(alpha, load(1)).

disposed(Id) :-
    agent_dispose(Id),
    wait_until(host_property(alpha, load(0)), 10).

empty :-
    wait_until(host_property(alpha, load(0)), 10).

alone :-
    host_property(alpha, load(0)),
    \+ agent_property(_, state(_)).

:- meta_predicate quietly(0).

quietly(Goal) :-
    capturing(Goal, _).
