:- module(typhon_image,
          [ image_hop/6,                % +Id, -Hops, +Goals, ?Mail, +Since,
                                        % -Image
            image_clone/5,              % +Id, +CloneId, +Goals, +Since, -Image
            image_hash/2,               % +Image, -Hash
            image_held/2,               % +Image, -Held
            image_handed/7,             % ?Id-Hash, ?Life, ?State, ?Held, ?Mail,
                                        % ?Since, ?Image
            image_filled/2,             % +Image0, -Image
            image_plain/8,              % +Image, -Id, -Hash, -Life, -Hops,
                                        % -Clauses, -Goals, -Since
            image_life/2,               % +Image, -Life
            image_label/2,              % +Image, -Label
            image_returned/3,           % +Image0, +Goals, -Image
            image_entrant/2,            % +Image, -Entrant
            image_amended/5,            % +Phase, +Host, +Where, +Image0,
                                        % -Image
            image_module/3,             % +Image, +Place, -Agent
            image_enter/4,              % +Image, +Host, +Agent, +More
            program_sent/3,             % +Endpoint, +Hash, -Sent
            program_missing/2           % +Endpoint, +Hash
          ]).
:- use_module(library(error), [type_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/durable', [durable_key/2, durable_on/0]).
:- use_module('../program', [code_sent/2]).
:- use_module('../wire', []).
:- use_module('../host', [amended/5, event_subscribed/1, host/3, parts/3]).
:- use_module(agents,
              [ agent/5, agent_enter/3, agent_mail/2, is_life/1, life_came/2,
                life_clone/3, life_hop/3, life_hops/2 ]).
:- use_module(agent_module, [agent_build/5, agent_state/2]).
:- use_module('../base/text', [is_printable/1]).
:- use_module(identity, [agent_home/2, origin_inherited/3]).
:- use_module(results, [no_result_facts/2]).

/** <module> The image of an agent, which goes over the wire

    image(Id, Hash, Life, State, Goals, Mail, Since)

Hash names the agent's program, Mail is a list of From-Message, the oldest
first, and Since the host time of its departure, or From-Since if a listener of
this process needs the host that the agent left.

The program is sent along unless the receiving process is known to have it.

*Threading*: any thread; image_enter/4 inside with_agent/2.
*/

:- multifile typhon_endpoint:connection/2.

:- dynamic has_program/2.       % Endpoint, Hash: the program was sent there

%!  image_hop(+Id, -Hops, +Goals, ?Mail, +Since, -Image) is det.
%
%   Image is the image of Id on its next hop, number Hops.

image_hop(Id, Hops, Goals, Mail, Since,
          image(Id, Hash, Life, State, Goals, Mail, Start)) :-
    agent(Id, Host, Module, Hash, Life0),
    life_hop(Life0, Life, Hops),
    agent_state(Module, State),
    start(Host, Since, Start).

%!  image_clone(+Id, +CloneId, +Goals, +Since, -Image) is det.
%
%   Image is the image of a clone of Id, to be sent elsewhere.

image_clone(Id, CloneId, Goals, Since,
            image(CloneId, Hash, Life, State, Goals, [], Start)) :-
    agent(Id, Host, Module, Hash, Life0),
    life_clone(Id, Life0, Life1),
    life_hop(Life1, Life, _),
    agent_state(Module, State0),
    no_result_facts(State0, State1),
    amended(cloned, Host, Id, State1, State2),
    origin_inherited(Id, State2, State),
    start(Host, Since, Start).

start(Host, Since, Start) :-
    (   event_subscribed(hops),
        host(Host, Address, _)
    ->  Start = Address-Since
    ;   Start = Since
    ).

%!  image_returned(+Image0, +Goals, -Image) is det.
%
%   Image is Image0 with Goals, on one hop more.

image_returned(image(Id, Hash, Life0, State, _, Mail, Start), Goals,
               image(Id, Hash, Life, State, Goals, Mail, Start)) :-
    life_hop(Life0, Life, _).

%!  image_entrant(+Image, -Entrant) is det.
%
%   Entrant is the form of Image that gate/4 takes.

image_entrant(image(Id, Hash, Life, State, _, Mail, _),
              entrant(Id, Hash, Life, State, Mail)).

%!  image_amended(+Phase, +Host, +Where, +Image0, -Image) is det.
%
%   Image is Image0 with its state amended by options of Host, see
%   typhon_host_parts: Where is To in the phase `departs`, and
%   from(Peer, Address) in the phase `arrives`.

image_amended(Phase, Host, Where, Image0, Image) :-
    (   parts(Phase, Host, _)
    ->  Image0 = image(Id, Hash, Life, State0, Goals, Mail, Start),
        life_hops(Life, Hops),
        amended(Phase, Host, hop(Id, Hash, Hops, Goals, Where), State0, State),
        Image = image(Id, Hash, Life, State, Goals, Mail, Start)
    ;   Image = Image0
    ).

%!  image_hash(+Image, -Hash) is det.

image_hash(image(_, Hash, _, _, _, _, _), Hash).

%!  image_held(+Image, -Held) is det.
%
%   Held is Image as a hand-over sends it: its goals are Hole-Goals, with the
%   hole filled already.

image_held(image(Id, Hash, Life, State, Goals, Mail, Start),
           image(Id, Hash, Life, State, true-Goals, Mail, Start)).

%!  image_handed(?Agent, ?Life, ?State, ?Held, ?Mail, ?Since, ?Image) is det.
%
%   Image is that of an agent that is handed over: Agent is Id-Hash, Held is
%   Hole-Goals.

image_handed(Id-Hash, Life, State, Hole-Goals, Mail, Since,
             image(Id, Hash, Life, State, Hole-Goals, Mail, Since)).

%!  image_filled(+Image0, -Image) is det.
%
%   The hole of an agent that was handed over, if Image0 is its image, is filled.

image_filled(image(Id, Hash, Life, State, Hole-Goals, Mail, Start), Image) :-
    !,
    Hole = true,
    Image = image(Id, Hash, Life, State, Goals, Mail, Start).
image_filled(Image, Image).

%!  image_plain(+Image, -Id, -Hash, -Life, -Hops, -Clauses, -Goals, -Since)
%!      is semidet.
%
%   Image, any term, is that of an agent without messages and extras that was
%   handed over.

image_plain(image(Id, Hash, Life, State, Hole-Goals, Mail, Since), Id, Hash,
            Life, Hops, Clauses, Goals, Since) :-
    Mail == [],
    atom(Id),
    sub_atom(Id, _, _, _, @),
    !,
    atom(Hash),
    number(Since),
    is_list(Goals),
    life_came(Life, Hops),
    nonvar(State),
    State = state(Empty, Clauses),
    Empty == [],
    is_list(Clauses),
    Hole = true.

%!  image_life(+Image, -Life) is semidet.
%
%   Life may be any term, as Image may.

image_life(Image, Life) :-
    subsumes_term(image(_, _, _, _, _, _, _), Image),
    Image = image(_, _, Life, _, _, _, _).

%!  image_label(+Image, -Label) is det.
%
%   Label is label(Id, Hops, Since, From), the parts of Image that are needed
%   before it is installed.  From is `none`, or the host that the agent left.  A
%   term that is no image is refused.  Errors in the state are found only when
%   the module of the agent is made.
%
%   @error type_error(agent_image, Name)

image_label(Image, label(Id, Hops, Since, From)) :-
    (   is_image(Image),
        Image = image(Id, _, Life, _, _, _, Start),
        started(Start, Since, From)
    ->  life_hops(Life, Hops)
    ;   image_name(Image, Name),
        type_error(agent_image, Name)
    ).

started(Since, Since, none) :-
    number(Since),
    !.
started(Start, Since, From) :-
    subsumes_term(_-_, Start),
    Start = From-Since,
    atom(From),
    number(Since).

is_image(image(Id, Hash, Life, State, Goals, Mail, _)) :-
    atom(Id),
    is_printable(Id),
    agent_home(Id, _),
    atom(Hash),
    is_life(Life),
    may_be_noted(Id, Life),
    subsumes_term(state(_, _), State),
    State = state(Empty, Clauses),
    is_list(Empty),
    is_list(Clauses),
    is_list(Goals),
    is_list(Mail),
    forall(member(Message, Mail), subsumes_term(_-_, Message)).

may_be_noted(Id, Life) :-
    (   durable_on
    ->  life_hops(Life, Hops),
        durable_key(Id, Hops)
    ;   true
    ).

%   The name or functor of Image: the whole would be too long for a message.

image_name(image(Id, _, _, _, _, _, _), Name) :-
    atom(Id),
    !,
    (   sub_atom(Id, 0, 100, After, Start),
        After > 0
    ->  atom_concat(Start, '...', Name)
    ;   Name = Id
    ).
image_name(Image, Name/Arity) :-
    callable(Image),
    !,
    functor(Image, Name, Arity).
image_name(Image, Image).

%!  image_module(+Image, +Place, -Agent) is semidet.
%
%   First step of installing an agent: make its module, as agent_build/5.

image_module(image(Id, Hash, _, State, Goals, _, _), Place, Agent) :-
    agent_build(Id, Place, Hash, State-Goals, Agent).

%!  image_enter(+Image, +Host, +Agent, +More:list) is det.
%
%   Second step: make the record of the agent, with its mail and More.  The
%   agent is ready, but not scheduled.

image_enter(image(Id, Hash, Life, _, _, Mail0, _), Host, Module-Goals, More) :-
    agent_enter(agent(Id, Host, Module, Hash, Life), ready, Goals),
    append(Mail0, More, Mail),
    (   Mail == []
    ->  true
    ;   agent_mail(Id, Mail)
    ).

                /*******************************
                *            PROGRAMS           *
                *******************************/

%!  program_sent(+Endpoint, +Hash, -Sent) is det.
%
%   Sent goes to Endpoint with an agent of that program: as in code_sent/2, or
%   `known`.

program_sent(Endpoint, Hash, known) :-
    has_program(Endpoint, Hash),
    !.
program_sent(Endpoint, Hash, Sent) :-
    code_sent(Hash, Sent),
    bounded(has_program(_, _), typhon_image:sent_programs,
            assertz(has_program(Endpoint, Hash))).

%!  program_missing(+Endpoint, +Hash) is det.
%
%   Record that the process at Endpoint lacks the program.

program_missing(Endpoint, Hash) :-
    retractall(has_program(Endpoint, Hash)).

%   A program whose entry was deleted is sent once more.

:- setting(sent_programs, positive_integer, 10 000,
           "Programs remembered as sent to another process").

typhon_endpoint:connection(Endpoint, down) :-
    retractall(has_program(Endpoint, _)).
