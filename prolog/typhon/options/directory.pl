:- module(typhon_directory,
          [ host_offers/2               % +Host, -Offers
          ]).
:- use_module('directory/directory_words', []).
:- autoload('directory/offers', [offers_on/2]).

/** <module> Directory: which agents offer which services

An agent offers a service on the host where it is, and other agents find it.
This is the interface of the layer; the module that keeps offers is loaded when
a service is first offered or looked for.

*Threading*: any thread.
*/

%!  host_offers(+Host, -Offers:list) is det.
%
%   Offers are the services that agents on Host offer: pairs
%   Agent-offer(Service, Properties), in the order of the offers.  Host is the
%   name of a host of this process.

host_offers(Host, Offers) :-
    offers_on(Host, Offers).
