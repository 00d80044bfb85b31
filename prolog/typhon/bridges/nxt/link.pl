:- module(typhon_nxt_link,
          [ link_open/3,                % +Brick, +Port, +Options
            link_close/1,               % +Brick
            link_request/4,             % +Brick, +What, +Fields, -Reply
            link_request/5,             % +Brick, +What, +Fields, +Seconds,
                                        % -Reply
            link_option/2,              % +Brick, ?Option
            link_brick/2                % ?Brick, ?Port
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../helper', [helper_ask/4, helper_close/1, helper_open/3]).
:- use_module(errors, [nxt_failure/4]).
:- use_module(helper, [nxt_command_line/3]).

/** <module> Requests to bricks, and their answers

Every brick that is connected has a helper.  One that died is replaced by
the next request.  A helper serves its requests one after the other;
different bricks have different helpers.

*Threading*: any thread may ask; see typhon_helper_requests.
*/

:- dynamic
    brick/3.                    % Brick, Port, Options

%!  link_open(+Brick, +Port, +Options) is det.
%
%   @error permission_error(connect, nxt_brick, Brick) if it is connected

link_open(Brick, Port, Options) :-
    nxt_command_line(Port, Options, Command),
    with_mutex(typhon_nxt, open_link(Brick, Port, Options, Command)).

open_link(Brick, _, _, _) :-
    brick(Brick, _, _),
    !,
    permission_error(connect, nxt_brick, Brick).
open_link(Brick, Port, Options, Command) :-
    sig_atomic(( helper_open(nxt(Brick), Command, []),
                 assertz(brick(Brick, Port, Options)) )).

%!  link_close(+Brick) is det.
%
%   End the helper.  Requests that are still open get an error.
%
%   @error existence_error(nxt_brick, Brick)

link_close(Brick) :-
    (   retract(brick(Brick, _, _))
    ->  helper_close(nxt(Brick))
    ;   existence_error(nxt_brick, Brick)
    ).

%!  link_brick(?Brick, ?Port) is nondet.

link_brick(Brick, Port) :-
    brick(Brick, Port, _).

%!  link_option(+Brick, ?Option) is nondet.
%
%   @error existence_error(nxt_brick, Brick)

link_option(Brick, Option) :-
    the_brick(Brick, _, Options),
    member(Option, Options).

the_brick(Brick, Port, Options) :-
    (   brick(Brick, Port, Options)
    ->  true
    ;   existence_error(nxt_brick, Brick)
    ).

%!  link_request(+Brick, +What, +Fields, -Reply) is det.
%!  link_request(+Brick, +What, +Fields, +Seconds, -Reply) is det.
%
%   Have the helper of Brick do What, a command of LEGO's document or what
%   the helper can do, with the dict Fields.  Reply is a dict.  Seconds is
%   the deadline, default that of the brick.
%
%   @error existence_error(nxt_brick, Brick)
%   @error See nxt_failure/4

link_request(Brick, What, Fields, Reply) :-
    the_brick(Brick, _, Options),
    option(deadline(Seconds), Options, 3),
    link_request(Brick, What, Fields, Seconds, Reply).

link_request(Brick, What, Fields, Seconds, Reply) :-
    the_brick(Brick, Port, _),
    catch(helper_ask(nxt(Brick), Fields, Seconds, Answer0),
          error(existence_error(helper, _), _),
          existence_error(nxt_brick, Brick)),
    answer_atoms(Answer0, Answer),
    (   Answer = ok(Reply)
    ->  true
    ;   nxt_failure(Answer, Brick, Port, What)
    ).

%   Texts are names here, and become atoms.

answer_atoms(ok(Reply0), ok(Reply)) :-
    !,
    atoms(Reply0, Reply).
answer_atoms(said(Dict0), said(Dict)) :-
    !,
    atoms(Dict0, Dict).
answer_atoms(Answer, Answer).

atoms(Dict0, Dict) :-
    is_dict(Dict0),
    !,
    dict_pairs(Dict0, Tag, Pairs0),
    maplist(atoms_pair, Pairs0, Pairs),
    dict_pairs(Dict, Tag, Pairs).
atoms(Text, Atom) :-
    string(Text),
    !,
    atom_string(Atom, Text).
atoms(Value, Value).

atoms_pair(Key-Value0, Key-Value) :-
    atoms(Value0, Value).
