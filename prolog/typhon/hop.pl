:- module(typhon_hop,
          [ hop/5,                      % +Id, +Dest, +Hole, +Goals, +Since
            hop_clone/6,                % +Id, +Dest, +CloneId, +Who, +Hole, +Goals
            hop_state/3,                % +Id, +Status, -State
            hop_program/3               % +Endpoint, +Hash, -Program
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(agent).
:- use_module(clock, [clock/3, host_time/2]).
:- use_module(code, [code_install/2, code_module/2, code_program/2]).
:- use_module(endpoint,
              [ endpoint_request/4, endpoint_reply/2, endpoint_peer/2 ]).
:- use_module(frame, [mobile_term/1]).
:- use_module(host,
              [ host/3, host_enter/3, host_leave/1, address_parts/3,
                host_hop/3 ]).
:- use_module(scheduler, [scheduler_call/1]).
:- use_module(post, [post/3]).
:- use_module(whereabouts,
              [ agent_seen/4, agent_left/4, agent_born/2, agent_ended/2,
                whereabouts/3, agent_outcome/2 ]).

/** <module> A hop is a transaction

The source freezes the agent and sends its image: state, payloads, goals,
mail.  The receiver installs it and answers, and only then does the source
let its copy go.  The id of a transfer is the agent with its number of
hops, so a repeat is recognised by what the receiver knows anyhow: the
agent stands here, has gone on, or has ended.  An agent that comes back
before the answer proves that it had arrived.

  | answer       | the source                                       |
  | ------------ | ------------------------------------------------ |
  | accepted     | forgets the agent; mail that came later follows  |
  | refused(Why) | raises move_refused(Host, Why) at the move       |
  | need_program | sends again, with the program                    |
  | unreachable  | raises host_unreachable(Host) at the move        |
  | lost         | asks the home, see settle/4                      |

*Threading*: hop/5 in a worker; answers and arrivals in the reader threads
of the endpoint, which never wait.
*/

:- setting(doubt_seconds, number, 3,
           "An agent under way for longer is shown as in doubt").

:- multifile
    forward_order/2,            % Id, Order: the agent has left
    typhon_endpoint:requested/4,
    typhon_endpoint:connection/2.

:- dynamic has_program/2.       % Endpoint, Hash: was sent there

%!  hop(+Id, +Dest, +Hole, +Goals, +Since) is det.
%
%   Send Id to Dest, remote(Address, Name, Endpoint) or local(Name), where
%   it goes on with Goals, Hole bound to `true`.
%
%   @arg Since is the host time at which it set out
%   @error type_error(mobile_term, Culprit)

hop(Id, Dest, Hole, Goals, Since) :-
    agent(Id, _, Module, Hash, Life0),
    one_hop_more(Life0, Life, Hops),
    agent_state(Module, State),
    copy_term(Hole-Goals, Hole1-Going),
    ignore(Hole1 = true),
    mobile_term(State-Going),
    dest_address(Dest, Address),
    with_agent(Id,
               ( agent_all_mail(Id, Mail),
                 agent_put(Id, transit(Address, Since),
                           hop(Hole-Goals, Hops, Mail))
               )),
    dispatch(Dest, image(Id, Hash, Life, State, Going, Mail, Since),
             hop(Id, Dest, Hops)).

one_hop_more(life(Parent, Hops0, Lifetime, Tokens, Payloads, Static),
             life(Parent, Hops, Lifetime, Tokens, Payloads, Static), Hops) :-
    Hops is Hops0+1.

%!  hop_clone(+Id, +Dest, +CloneId, +Who, +Hole, +Goals) is det.
%
%   Send a clone of Id to Dest; Id waits for the answer, Goals its goals.

hop_clone(Id, Dest, CloneId, Who, Hole, Goals) :-
    agent(Id, Host, Module, Hash, Life0),
    clone_life(Id, Life0, Life),
    agent_state(Module, State),
    copy_term(Hole-Goals-Who, (Who1=clone(Id))-Going-Who1),
    mobile_term(State-Going),
    host_time(Host, Since),
    dest_address(Dest, Address),
    with_agent(Id, agent_put(Id, cloning(Address, Since),
                             clone(Hole-Goals-Who, CloneId))),
    host(Host, Here, _),
    agent_born(CloneId, Here),
    dispatch(Dest, image(CloneId, Hash, Life, State, Going, [], Since),
             clone(Id, Dest, CloneId)).

clone_life(Id, life(_, _, Lifetime, Tokens, Payloads, Static),
           life(Id, 1, Lifetime, Tokens, Payloads, Static)).

%   image(+For, -Image): once more, from the frozen record.

image(hop(Id, _, Hops), image(Id, Hash, Life, State, Going, Mail, Since)) :-
    agent(Id, _, Module, Hash, Life0),
    agent_status(Id, transit(_, Since), hop(Hole-Going, Hops, Mail)),
    ignore(Hole = true),
    one_hop_more(Life0, Life, Hops),
    agent_state(Module, State).
image(clone(Id, _, CloneId),
      image(CloneId, Hash, Life, State, Going, [], Since)) :-
    agent(Id, _, Module, Hash, Life0),
    agent_status(Id, cloning(_, Since), clone(Hole-Going-Who, CloneId)),
    Hole = (Who=clone(Id)),
    clone_life(Id, Life0, Life),
    agent_state(Module, State).

dest_address(local(Name), Address) :-
    host(Name, Address, _).
dest_address(remote(Address, _, _), Address).

dest_endpoint(local(Name), Name, Endpoint) :-
    host(Name, Address, _),
    address_parts(Address, _, Endpoint).
dest_endpoint(remote(_, Name, Endpoint), Name, Endpoint).

%   dispatch(+Dest, +Image, +For): send Image; For says what to do with
%   the answer.

dispatch(Dest, Image, For) :-
    dest_endpoint(Dest, Name, Endpoint),
    arg(2, Image, Hash),
    (   has_program(Endpoint, Hash)
    ->  Program = known
    ;   hop_program(Endpoint, Hash, Program)
    ),
    send(Endpoint, Name, Image, Program, For).

send(Endpoint, Name, Image, Program, For) :-
    endpoint_request(Endpoint, hop, hop(Name, Image, Program),
                     typhon_hop:answered(For, Endpoint, Name)).

%!  hop_program(+Endpoint, +Hash, -Program) is det.
%
%   The program to send to Endpoint, which lacks it as far as we know.

hop_program(Endpoint, Hash, Program) :-
    code_program(Hash, Program),
    (   has_program(Endpoint, Hash)
    ->  true
    ;   assertz(has_program(Endpoint, Hash))
    ).

typhon_endpoint:connection(Endpoint, down) :-
    retractall(has_program(Endpoint, _)).

                /*******************************
                *          THE SOURCE          *
                *******************************/

answered(For, Endpoint, Name, Result) :-
    (   Result == answer(need_program)
    ->  image(For, Image),
        arg(2, Image, Hash),
        hop_program(Endpoint, Hash, Program),
        send(Endpoint, Name, Image, Program, For)
    ;   outcome(For, Result)
    ).

outcome(hop(Id, Dest, Hops), Result) :-
    hop_result(Result, Id, Dest, Hops).
outcome(clone(Id, Dest, CloneId), Result) :-
    clone_result(Result, Id, Dest, CloneId).

hop_result(answer(accepted), Id, Dest, Hops) :-
    !,
    dest_address(Dest, Address),
    dest_endpoint(Dest, _, Endpoint),
    (   with_agent(Id, let_go(Id, Hops, Host, Since, Mail, Orders))
    ->  agent_left(Id, Address, Hops, Endpoint),
        gone(Host, Since),
        forall(member(From-Message, Mail), follow(Id, From, Message)),
        forall(member(Order, Orders),
               scheduler_call(typhon_hop:forward_order(Id, Order)))
    ;   true                            % it came back before the answer
    ).
hop_result(answer(refused(Reason)), Id, Dest, Hops) :-
    !,
    dest_address(Dest, Address),
    back(Id, Hops, move_refused(Address, Reason)).
hop_result(unreachable, Id, Dest, Hops) :-
    !,
    dest_address(Dest, Address),
    back(Id, Hops, host_unreachable(Address)).
hop_result(lost, Id, Dest, Hops) :-
    settle(Id, Dest, Hops).

let_go(Id, Hops, Host, Since, Mail, Orders) :-
    agent_status(Id, transit(_, Since), hop(_, Hops, _)),
    agent(Id, Host, _, _, _),
    agent_all_mail(Id, Mail),
    findall(Order, agent_next_order(Id, Order), Orders),
    agent_remove(Id).

gone(Host, Since) :-
    host_leave(Host),
    (   host_time(Host, Now)
    ->  Seconds is max(0.0, Now-Since),
        host_hop(Host, out, Seconds)
    ;   true                            % the host was stopped meanwhile
    ).

follow(Id, From, Message) :-
    catch(post(Id, From, Message),
          error(Formal, _),
          print_message(warning,
                        typhon(undeliverable(Formal, Id, From, Message)))).

%   The agent stays; Error is raised at its move.  If the move was ordered
%   from outside there is no hole, and it is reported instead.

back(Id, Hops, Error) :-
    ignore(with_agent(Id, back_(Id, Hops, Error))).

back_(Id, Hops, Error) :-
    agent_status(Id, transit(_, _), hop(Hole-Goals, Hops, Mail)),
    agent_return_mail(Id, Mail),
    (   Hole == ordered
    ->  print_message(warning, typhon(order_failed(Id, Error)))
    ;   Hole = throw(error(Error, _))
    ),
    agent_ready(Id, Goals).

%   settle(+Id, +Dest, +Hops): the process at Dest is not the one to which
%   the agent was sent.  If the home has news of a later hop the agent got
%   away in time; else it has not survived there, and goes on here.

settle(Id, Dest, Hops) :-
    (   settled_elsewhere(Id, Hops)
    ->  hop_result(answer(accepted), Id, Dest, Hops)
    ;   dest_address(Dest, Address),
        back(Id, Hops, host_unreachable(Address))
    ).

settled_elsewhere(Id, Hops) :-
    (   agent_outcome(Id, _)
    ;   whereabouts(Id, _, Hops1),
        Hops1 >= Hops
    ),
    !.

clone_result(Result, Id, Dest, CloneId) :-
    dest_address(Dest, Address),
    (   clone_error(Result, Address, Error)
    ->  agent_ended(CloneId, failed),
        Answer = throw(error(Error, _))
    ;   Answer = parent(CloneId)
    ),
    ignore(with_agent(Id, clone_back(Id, CloneId, Answer))).

clone_error(answer(refused(Reason)), Address, move_refused(Address, Reason)).
clone_error(unreachable, Address, host_unreachable(Address)).
clone_error(lost, Address, host_unreachable(Address)).

clone_back(Id, CloneId, Answer) :-
    agent_status(Id, cloning(_, _), clone(Hole-Goals-Who, CloneId)),
    (   Answer = parent(_)
    ->  Hole = (Who=Answer)
    ;   Hole = Answer
    ),
    agent_ready(Id, Goals).

%!  hop_state(+Id, +Status, -State) is det.
%
%   State is `in_transit` or `in_doubt`: the answer is overdue, or the
%   connection on which it should come is broken.

hop_state(Id, transit(Address, Since), State) :-
    (   address_parts(Address, _, Endpoint),
        endpoint_peer(Endpoint, state(down))
    ->  State = in_doubt
    ;   agent(Id, Host, _, _, _),
        clock(Host, Epoch, Rate),
        get_time(Now),
        setting(doubt_seconds, Limit),
        Now-(Epoch+Since/Rate) > Limit
    ->  State = in_doubt
    ;   State = in_transit
    ).

                /*******************************
                *         THE RECEIVER         *
                *******************************/

typhon_endpoint:requested(hop, hop(Name, Image, Program), Peer, ReplyTo) :-
    catch(arrive(Name, Image, Program, Peer, Answer),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            Answer = refused(error(Formal))
          )),
    answer(Answer, Image, ReplyTo).

%   The agent must not run before the answer is on its way: what it sends
%   comes behind it.

answer(installed(Goals), Image, ReplyTo) :-
    !,
    endpoint_reply(ReplyTo, accepted),
    arg(1, Image, Id),
    with_agent(Id, agent_ready(Id, Goals)).
answer(Answer, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Answer).

arrive(Name, Image, Program, Peer, Answer) :-
    Image = image(Id, Hash, Life, _, _, _, _),
    (   repeated(Id, Life)
    ->  Answer = accepted
    ;   \+ has_code(Hash, Program)
    ->  Answer = need_program
    ;   arg(4, Life, Tokens),
        host_enter(Name, Tokens, Entered),
        admitted(Entered, Name, Image, Peer, Answer)
    ).

%   A transfer that was answered before.

repeated(Id, Life) :-
    arg(2, Life, Hops),
    (   agent(Id, _, _, _, Life0)
    ->  arg(2, Life0, Hops0),
        Hops0 >= Hops
    ;   whereabouts(Id, _, Hops0)
    ->  Hops0 >= Hops
    ;   agent_outcome(Id, _)
    ).

has_code(Hash, Program) :-
    (   code_module(Hash, _)
    ->  true
    ;   Program \== known,
        code_install(Hash, Program)
    ).

admitted(refused(Reason), _, _, _, refused(Reason)).
admitted(ok, Name, Image, Peer, installed(Goals)) :-
    Image = image(Id, Hash, Life, State, Goals, Mail, Since),
    host(Name, Address, Place),
    arg(2, Life, Hops),
    catch(with_agent(Id, install(Id, Name, Place, Hash, Life, State, Mail)),
          Ball,
          ( host_leave(Name), throw(Ball) )),
    agent_seen(Id, Address, Hops, Peer),
    host_time(Name, Now),
    Seconds is max(0.0, Now-Since),
    host_hop(Name, in, Seconds).

install(Id, Name, Place, Hash, Life, State, Mail) :-
    came_back(Id, Later, Orders),
    agent_install(Id, Name, Place, Hash, Life, State),
    agent_put(Id, arriving, []),
    forall(member(Message, Mail), agent_mail(Id, Message)),
    forall(member(Message, Later), agent_mail(Id, Message)),
    forall(member(Order, Orders), agent_order(Id, Order)).

%   Our own copy, still waiting for the answer, is out of date.

came_back(Id, Mail, Orders) :-
    agent_status(Id, transit(_, _), hop(_, Hops, _)),
    !,
    let_go(Id, Hops, Host, Since, Mail, Orders),
    gone(Host, Since).
came_back(_, [], []).
