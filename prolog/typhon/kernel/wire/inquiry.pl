:- module(typhon_inquiry,
          [ endpoint_ask_all/6          % +Addresses, +Kind, +Term, :Further,
                                        % +Seconds, -Results
          ]).

/** <module> To ask many at once, and wait for all under one deadline

A peer that has died without a word costs who asks the time to the deadline,
however many there are of the kind.

*Threading*: any thread but those of the endpoint: it waits.
*/

:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/3, member/2, selectchk/3, subtract/3]).
:- use_module(messaging, [endpoint_request/4]).
:- use_module(request, [request_forget/1]).
:- use_module(unsent, [unsent_forget/1]).

:- meta_predicate
    endpoint_ask_all(+, +, +, 2, +, -).

%!  endpoint_ask_all(+Addresses, +Kind, +Term, :Further, +Seconds, -Results)
%!      is det.
%
%   Ask the endpoints at Addresses, and those that turn up meanwhile: of an
%   answer call(Further, Answer, More) tells More addresses. Each is asked
%   once. Results are Address-Result in no order, Result being one of
%   endpoint_request/4, or `late` where there was none after Seconds.

endpoint_ask_all(Addresses, Kind, Term, Further, Seconds, Results) :-
    must_be(number, Seconds),
    get_time(Now),
    Deadline is Now+Seconds,
    setup_call_cleanup(
        message_queue_create(Queue),
        ( ask(Addresses, Kind-Term, Queue),
          gather(Addresses, Addresses, asking(Kind-Term, Queue, Further),
                 Deadline, Results)
        ),
        message_queue_destroy(Queue)).

ask(Addresses, Kind-Term, Queue) :-
    forall(member(Address, Addresses),
           endpoint_request(Address, Kind, Term,
                            typhon_inquiry:told(Queue, Address))).

told(Queue, Address, Result) :-
    catch(thread_send_message(Queue, Address-Result),
          error(existence_error(_, _), _),
          true).                        % nobody waits any more

%   gather(+Open, +Asked, +Asking, +Deadline, -Results)

gather([], _, _, _, []) :-
    !.
gather(Open, Asked, Asking, Deadline, [Address-Result|Results]) :-
    Asking = asking(Question, Queue, Further),
    before(Deadline, Queue, Address-Result),
    !,
    selectchk(Address, Open, Open1),
    more(Result, Further, Asked, New),
    ask(New, Question, Queue),
    append(New, Open1, Open2),
    append(New, Asked, Asked2),
    gather(Open2, Asked2, Asking, Deadline, Results).
gather(Open, _, asking(_, Queue, _), _, Results) :-
    forall(member(Address, Open), forget(told(Queue, Address))),
    findall(Address-late, member(Address, Open), Results).

before(Deadline, Queue, Message) :-
    get_time(Now),
    Wait is max(0, Deadline-Now),
    thread_get_message(Queue, Message, [timeout(Wait)]).

more(answer(Answer), Further, Asked, New) :-
    call(Further, Answer, More),
    !,
    sort(More, Set),
    subtract(Set, Asked, New).
more(_, _, _, []).

%   What nobody waits for must not keep a session busy.

forget(OnAnswer) :-
    unsent_forget(OnAnswer),
    request_forget(OnAnswer).
