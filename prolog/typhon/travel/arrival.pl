:- module(typhon_arrival, []).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [type_error/2]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module('../program', [code_module/2, code_receive/2]).
:- use_module('../wire', [endpoint_reply/2, endpoint_reply_later/2]).
:- use_module('../host',
              [ host/3, host_enter/3, host_hop/3, host_leave/1, host_time/2,
                schedule/2 ]).
:- use_module('../agent',
              [ agent/5, agent_enter/5, agent_home/2, agent_mail/2,
                agent_module/5, agent_order/2, agent_put/3, agent_status/3,
                with_agent/2 ]).
:- use_module(hop, [hop_let_go/4]).
:- use_module(post, [post_waiting/2]).
:- use_module(whereabouts, [agent_heard_of/2, agent_outcome/2, agent_seen/4]).

/** <module> Agents arrive

The other half of a hop, see typhon_hop: install what comes, whole or not at
all, and answer.  A transfer that comes again is recognised by what is known anyhow: the agent
stands here, has gone on, or has ended.

*Threading*: the reader threads of the endpoint.
*/

:- multifile typhon_endpoint:requested/4.

typhon_endpoint:requested(hop, hop(Name, Image, Program), Peer, ReplyTo) :-
    catch(arrive(Name, Image, Program, Peer, Answer),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            Answer = refused(error(Formal))
          )),
    answer(Answer, Name, ReplyTo).

%   The agent must not run before the answer is on its way: what it sends
%   comes behind it.

answer(installed(Id), Name, ReplyTo) :-
    !,
    endpoint_reply_later(ReplyTo, accepted),
    schedule(Name, Id).
answer(Answer, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Answer).

arrive(Name, Image, Program, Peer, Answer) :-
    check_image(Image),
    Image = image(Id, Hash, Life, _, _, _, _),
    (   repeated(Id, Life)
    ->  Answer = accepted
    ;   \+ has_code(Hash, Program)
    ->  Answer = need_program
    ;   arg(4, Life, Tokens),
        host_enter(Name, Tokens, Entered),
        admitted(Entered, Name, Image, Peer, Answer)
    ).

%   What is not an agent is refused before anything is changed.  Whether the
%   state can be installed is seen when its module is made.

check_image(Image) :-
    (   Image = image(Id, Hash, Life, State, Goals, Mail, Since),
        atom(Id),
        agent_home(Id, _),
        atom(Hash),
        is_life(Life),
        State = state(Empty, Clauses),
        maplist(is_list, [Empty, Clauses, Goals, Mail]),
        forall(member(Message, Mail), subsumes_term(_-_, Message)),
        number(Since)
    ->  true
    ;   image_name(Image, Name),
        type_error(agent_image, Name)
    ).

%   The whole would be too long for a message.

image_name(image(Id, _, _, _, _, _, _), Name) :-
    atom(Id),
    !,
    Name = Id.
image_name(Image, Name/Arity) :-
    callable(Image),
    !,
    functor(Image, Name, Arity).
image_name(Image, Image).

is_life(life(Parent, Hops, Lifetime, Tokens, Payloads, Static)) :-
    atom(Parent),
    integer(Hops),
    atomic(Lifetime),
    is_list(Tokens),
    is_list(Payloads),
    atom(Static).

repeated(Id, Life) :-
    arg(2, Life, Hops),
    (   agent(Id, _, _, _, Life0)
    ->  arg(2, Life0, Hops0),
        Hops0 >= Hops
    ;   agent_outcome(Id, _)
    ->  true
    ;   agent_heard_of(Id, Hops0),
        Hops0 >= Hops
    ).

%   @error domain_error(program_of_hash(Hash), Program)

has_code(Hash, Program) :-
    (   code_module(Hash, _)
    ->  true
    ;   Program \== known,
        code_receive(Hash, Program)
    ).

admitted(refused(Reason), _, _, _, refused(Reason)).
admitted(ok, Name, Image, Peer, Answer) :-
    catch(install(Name, Image, Installed), Ball,
          ( host_leave(Name), throw(Ball) )),
    installed(Installed, Name, Image, Peer, Answer).

%   The host was stopped, or the program thrown out, since we looked; or
%   there are two agents of this id, one of which was taken for dead: the
%   one that is here stays.

installed(in(Gone), Name, Image, Peer, installed(Id)) :-
    arg(1, Image, Id),
    call(Gone),
    report_arrival(Name, Image, Peer).
installed(repeated, Name, _, _, accepted) :-
    host_leave(Name).
installed(unknown_host, Name, _, _, refused(unknown_host)) :-
    host_leave(Name).
installed(need_program, Name, _, _, need_program) :-
    host_leave(Name).

%   install(+Name, +Image, -Installed): all or nothing.

install(Name, Image, Installed) :-
    arg(1, Image, Id),
    (   host(Name, _, Place)
    ->  with_agent(Id, install(Image, Name, Place, Installed))
    ;   Installed = unknown_host
    ).

install(image(Id, Hash, Life, State, Goals, Mail0, _), Name, Place,
        Installed) :-
    (   overtaken(Id, Life)
    ->  Installed = repeated
    ;   \+ code_module(Hash, _)
    ->  Installed = need_program
    ;   agent_module(Id, Place, Hash, State, Module),
        let_go(Id, Later, Orders, Gone),
        agent_enter(Id, Name, Module, Hash, Life),
        agent_put(Id, ready, Goals),
        post_waiting(Id, Last),
        append([Mail0, Later, Last], Mail),
        forall(member(Message, Mail), agent_mail(Id, Message)),
        forall(member(Order, Orders), agent_order(Id, Order)),
        Installed = in(Gone)
    ).

overtaken(Id, Life) :-
    repeated(Id, Life),
    !.
overtaken(Id, _) :-
    agent_status(Id, Status, _),
    Status \= transit(_, _).

%   Our own copy, still waiting for the answer, is out of date.

let_go(Id, Mail, Orders, Gone) :-
    (   agent(Id, _, _, _, _)
    ->  hop_let_go(Id, Mail, Orders, Gone)
    ;   Mail = [],
        Orders = [],
        Gone = true
    ).

report_arrival(Name, Image, Peer) :-
    Image = image(Id, _, Life, _, _, _, Since),
    arg(2, Life, Hops),
    (   host(Name, Address, _),
        host_time(Name, Now)
    ->  agent_seen(Id, Address, Hops, Peer),
        Seconds is max(0.0, Now-Since),
        host_hop(Name, in, Seconds)
    ;   true                            % the host is being stopped
    ).
