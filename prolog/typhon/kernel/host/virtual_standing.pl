:- module(typhon_virtual_standing,
          [ standing/3,                 % +Queue, +Alarms, -Standing
            standing_again/3            % +Standing, +Queue, -Alarms
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(heaps), [heap_to_list/2, list_to_heap/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../base/fifo', [fifo_empty/2]).

/** <module> Where virtual time stands

A term from which it can go on, as it would have:

    virtual(Now, Random, Count, Alarms, Messages)

the time, the state of the generator, the number of the next alarm, those
alarms that are waited for, and what is still to be heard in the queue,
without questions.

*Threading*: the thread of virtual time, see virtual_loop.
*/

:- multifile
    typhon_scheduler:over/2.            % Agent, Token: it is not needed any more

%!  standing(+Queue, +Alarms, -Standing) is det.
%!  standing_again(+Standing, +Queue, -Alarms) is det.
%
%   So it stands; so it stands again.  Events that were not reported yet, as at the
%   beginning, comes after what was in the queue then.

standing(Queue, alarms(Count, Heap),
         virtual(Now, Random, Count, Alarms, Messages)) :-
    flag(typhon_virtual_now, Now, Now),
    random_property(state(Random)),
    heap_to_list(Heap, All0),
    exclude(is_over, All0, Alarms),
    fifo_empty(Queue, All),
    forall(member(Message, All), thread_send_message(Queue, Message)),
    exclude(is_question, All, Messages).

is_over(_-(Agent-Token)) :-
    catch(typhon_scheduler:over(Agent, Token), error(_, _), fail).

is_question(ask(_)).
is_question(held(_)).

standing_again(virtual(Now, Random, Count, Alarms, Messages), Queue,
               alarms(Count, Heap)) :-
    flag(typhon_virtual_now, _, Now),
    set_random(state(Random)),
    list_to_heap(Alarms, Heap),
    fifo_empty(Queue, Newer),
    append(Messages, Newer, All),
    forall(member(Message, All), thread_send_message(Queue, Message)).
