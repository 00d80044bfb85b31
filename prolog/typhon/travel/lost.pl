:- module(typhon_lost,
          [ mail_lost/3                 % +Formal, +Id, +Mail
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../wire', [endpoint_address/1, endpoint_post/3]).
:- use_module('../host', [scheduler_call/1]).
:- use_module(home, [agent_outcome/2]).

/** <module> Messages that find nobody

*Threading*: any thread.
*/

:- multifile
    error:has_type/2,
    typhon_endpoint:received/3.

%!  mail_lost(+Formal, +Id, +Mail) is det.
%
%   Said here and where it was sent.  That an agent has ended is nothing
%   special.

mail_lost(_, Id, _) :-
    agent_outcome(Id, _),
    !.
mail_lost(Formal, Id, Mail) :-
    report(Formal, Id, Mail),
    findall(Origin, member(mail(Origin, _, _), Mail), Origins0),
    sort(Origins0, Origins),
    forall(( member(Origin, Origins), \+ endpoint_address(Origin) ),
           scheduler_call(tell_origin(Origin, Formal, Id, Mail))).

tell_origin(Origin, Formal, Id, Mail) :-
    findall(mail(Origin, From, Message),
            member(mail(Origin, From, Message), Mail), Lost),
    catch(endpoint_post(Origin, message, lost(Formal, Id, Lost)),
          error(unreachable(_), _),
          true).                        % gone, and it was said here

report(Formal, Id, [mail(_, From, Message)|More]) :-
    (   More == []
    ->  Told = undeliverable(Formal, Id, From, Message)
    ;   length(More, Others),
        Told = undeliverable(Formal, Id, From, Message, Others)
    ),
    print_message(warning, typhon(Told)).

typhon_endpoint:received(message, lost(Formal, Id, Mail), _) :-
    must_be(list(typhon_mail), Mail),
    report(Formal, Id, Mail).

error:has_type(typhon_mail, Mail) :-
    subsumes_term(mail(_, _, _), Mail),
    arg(1, Mail, Origin),
    atom(Origin).
